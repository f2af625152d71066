// What layers (layers.h) are made of: the sums that a user or a denoiser asks for, and samples.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "renderer/film/pixel_plane.h"
#include "renderer/transport/integrator.h"

namespace lull {

// The AOVs that denoisers and compositors read ("arbitrary output variables").

// Which are wanted, and how.
struct AovSet {
    bool albedo = false, normal = false, depth = false, position = false, object = false,
         material = false, noise = false, alpha = false, cryptomatte = false;
    // Follow surfaces with only perfectly specular lobes to the next surface.
    bool throughSpecular = false;

    bool Any() const { return Hits() || noise || Mattes(); }
    // Return whether any is a property of first hits, and whether any is a coverage by them.
    bool Hits() const { return albedo || normal || depth || position || object || material; }
    bool Mattes() const { return alpha || cryptomatte; }
    bool operator==(const AovSet&) const = default;
};

// Names the AOVs: "albedo,normal,..." in the order above, without throughSpecular.
std::string NameOf(const AovSet&);
// Returns the same in words, with throughSpecular, for headers.
std::string TextOf(const AovSet&);

// Returns the names of all, with a separator between them.
std::string AllAovs(const char* separator);

// Reads such names, in any order. Throws Error naming the first unknown one.
AovSet ParseAovs(const std::vector<std::string>& names);

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
