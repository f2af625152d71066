// What layers (layers.h) are made of: the sums that a user or a denoiser asks for, and samples.
#pragma once

#include "renderer/film/aov_set.h"
#include "renderer/film/pixel_plane.h"
#include "renderer/transport/first_hit.h"
#include "renderer/transport/group_radiance.h"

namespace lull {

// Which sums are wanted in addition to the colours of the film.
struct LayerOptions {
    AovSet aovs = {};
    bool features = false;         // for the denoiser: of first hits, and noise
    LightGroups groups = {};       // whose light is told apart
    bool groupNoise = false;       // for the denoiser: of each group
    bool groupBackground = false;  // the light of each group that meets nothing

    // Returns whether first hits are seen in mirrors and through glass, as is best for a denoiser;
    // AOVs, which are of the same hits, take precedence.
    bool ThroughSpecular() const { return aovs.Any() ? aovs.throughSpecular : features; }
    // Returns the same in words.
    const char* HitsText() const {
        return ThroughSpecular() ? "through mirrors and glass" : "of the first surface";
    }
};

// Sample `index` of a pixel.
struct LayerSample {
    uint32_t index = 0;
    Rgb radiance = Rgb::Zero();
    FirstHit hit = {};                      // where a layer needs it
    const GroupRadiance* groups = nullptr;  // of LayerOptions::groups, where there are any
};

// The light that light paths bring to a pixel in a round, of which some samples are added to it
// (render/light_rounds.h). Each of these has the share `each` of the luminance.
struct SplatLight {
    std::array<double, 3> sum = {}, halfSum = {};  // of these samples
    double squares = 0;                            // of luminance, of single light paths
    double each = 0, samples = 0;

    // Returns how the sum of the squares of samples grows, whose luminance is `camera` without it:
    // the variance of the light is that of a Poisson process.
    double Squares(double camera) const {
        return squares + 2 * each * camera + samples * each * each;
    }
};

}  // namespace lull
