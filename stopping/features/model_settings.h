// The inputs of a learned rule, and how its answers count.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "stopping/signals/entropy_drop.h"

namespace lull {

// Measurements of a block: the entropies of each of m sub-blocks (the paper's features, see
// svd_entropy.h), the visible noise of each of 10 x 10 sub-blocks, from the fall of the entropies H
// since half as many samples (entropy_drop.h; for m = 100), and the differences to filtered
// versions of the whole block (attributes26.h).
enum class Feature { H, H1, H2, VisibleDrop, Attributes26 };

// Convert to and from names: "H", "H1", "H2", "visible_drop" and "attributes26"; a list is
// separated by commas. ParseFeatures() throws std::invalid_argument for others, and for duplicates.
std::string FeatureNames(std::span<const Feature> features);
std::vector<Feature> ParseFeatures(const std::string& names);
inline bool IsEntropy(Feature feature) { return feature <= Feature::H2; }
// Returns whether a feature is the standard deviation of noise in lightness, which `caution`
// scales.
inline bool IsNoise(Feature feature) { return feature == Feature::VisibleDrop; }
// Returns whether this feature is normalised over a window, as the paper does with both of its
// features.
inline bool IsNormalized(Feature feature) { return !IsNoise(feature); }
// Returns whether there is a value for each sub-block.
inline bool HasSubBlocks(Feature feature) { return feature != Feature::Attributes26; }

// How far apart the steps of a window are: n spp, or each at `ratio` times the spp of the
// previous one, or the nearest that is kept (see history.h).
enum class Spacing { Fixed, Geometric };
std::string SpacingName(Spacing spacing);       // "fixed" or "geometric"
Spacing ParseSpacing(const std::string& name);  // throws std::invalid_argument

// Inputs and votes of a model; the defaults are the paper's.
struct ModelSettings {
    int k = 8;    // steps in a window
    int n = 40;   // spp between them; with geometric spacing between those that are looked at
    int m = 100;  // sub-blocks that entropies are computed of, a square number
    std::vector<Feature> features = {Feature::H};
    bool takesMean = false;  // of the sub-blocks' values, instead of each
    bool snorm = true;       // normalise entropies and attributes over the window, each by itself
    int votes = 3;           // noiseless votes in a row that stop a block
    int voteSpacing = 0;     // spp between votes; 0: vote after every pass
    Spacing spacing = Spacing::Fixed;
    double ratio = 2;                 // of geometric spacing, > 1
    NoiseVisibility visibility = {};  // of visible_drop
    // Peak noise of the block (PeakNoise() in signals/lightness_noise.h), in L*, times
    // NearnessFactor(), from which on a check is no vote to stop, whatever the network's answer; 0:
    // none.
    double peakLimit = 0;
    // Multiplies noise; not part of a model, but of how it is used.
    double caution = 1;
};

bool Needs(const ModelSettings& settings, Feature feature);

// Throws std::invalid_argument naming the setting that is out of range. (There cannot be more
// sub-blocks than the smallest voting block has pixels, so that no block is too small.)
void CheckSettings(const ModelSettings& settings);

}  // namespace lull
