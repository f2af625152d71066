// What layers (layers.h) are made of: the sums that a user or a denoiser asks for, and samples.
#pragma once

#include <span>

#include "renderer/film/aov_set.h"
#include "renderer/film/pixel_plane.h"
#include "renderer/transport/group_radiance.h"
#include "renderer/transport/integrator.h"

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

// Light that light paths bring to some samples of a pixel (render/light_rounds.h).
struct SplatLight {
    std::array<double, 3> sum = {}, halfSum = {};
    double squares = 0;  // of luminance, of single light paths
    double each = 0;     // the luminance that each sample gets of it
    double samples = 0;
    double camera = 0;  // the luminance of these samples without it

    // Returns how much the squares of the samples' luminance add up to more by it: its variance is
    // that of a Poisson process.
    double Squares() const { return squares + 2 * each * camera + samples * each * each; }
};

// The light of all groups of lights together, and of each where there are any.
struct PixelSplats {
    SplatLight all;
    std::span<const SplatLight> groups = {};
};

}  // namespace lull
