// Turns measures of a block into the inputs of a network, in the same way for training, from
// recordings, and for judging, from pixels.
#pragma once

#include <array>
#include <vector>

#include "stopping/base/block_view.h"
#include "stopping/features/model_settings.h"

namespace lull {

// The number of sub-blocks for statistics other than entropies, as in recordings.
inline constexpr int kMeasuredSubBlocks = 100;

// The measures of a block at one spp: for each feature the values of its sub-blocks,
// row-major (m entropies, kMeasuredSubBlocks of other statistics), or the attributes of the block;
// empty if it is not asked for.
struct BlockMeasures {
    int spp = 0;
    std::array<std::vector<double>, size_t(Feature::Attributes26) + 1> values = {};
    SubBlockLightness lightness = {};  // for visible_drop

    std::vector<double>& Of(Feature feature) { return values[size_t(feature)]; }
    const std::vector<double>& Of(Feature feature) const { return values[size_t(feature)]; }
};

// Measures the features of the settings; for drops, which BlockMemory completes, their entropies
// and lightness. Throws as CheckView() and SubBlockEntropies() do.
BlockMeasures MeasureBlock(const BlockView& view, const ModelSettings& settings);

// Which places in the input of a network belong to a feature.
struct InputRange {
    Feature feature;
    int begin = 0, count = 0;
};

// Returns the ranges in the order of the settings' features; they cover all inputs.
std::vector<InputRange> InputRanges(const ModelSettings& settings);
int InputCount(const ModelSettings& settings);

// Returns the input of one step, InputCount() values, before it is normalised over a window:
// entropies and attributes as they are; noise, times the caution, as log(v + 0.1), of its mean if
// that is taken. Throws std::invalid_argument if the measures of a feature have a wrong length.
std::vector<double> InputVector(const BlockMeasures& measures, const ModelSettings& settings);

// Returns whether the mean noise is the only input of a network.
bool LooksAtNoiseOnly(const ModelSettings& settings);

// Convert that noise, >= 0, times the caution, to the network's input, and back.
double InputOfNoise(double noise);
double NoiseOfInput(double input);

}  // namespace lull
