// Describes a block of an image to those who measure and judge it.
#pragma once

#include <cstddef>
#include <span>
#include <stdexcept>

namespace lull {

// Shows the state of a block after a pass; read-only, valid only during the call that receives it.
struct BlockView {
    int width = 0, height = 0;  // pixels, > 0
    int spp = 0;                // samples that every pixel has had, > 0
    // Linear radiance, 3 * width * height values: R, G, B of the first pixel, row by row. All
    // finite (other values lead to no NaN, but to meaningless results). The half mean is the mean
    // over one fixed half of the samples.
    std::span<const float> mean = {}, halfMean = {};
    // CPU time of the samples so far and of this view, in seconds, for measurements of rules. A
    // rule that used them would not be deterministic.
    double seconds = 0, viewSeconds = 0;
};

// Spans of a BlockView that are read; the others may be left empty. Measured: both, and the
// program's own measurements (RuleContext::measures in rules/rule.h), for which it needs all
// of the block's samples. Each needs those before it.
enum class ViewNeed { Nothing, Mean, MeanAndHalf, Measured };

// Checks that a view has a size, samples and the spans in `need`. Throws std::invalid_argument.
inline void CheckView(const BlockView& view, ViewNeed need) {
    if (view.width < 1 || view.height < 1 || view.spp < 1)
        throw std::invalid_argument("a block needs pixels and samples");
    const size_t values = 3 * size_t(view.width) * size_t(view.height);
    if ((need != ViewNeed::Nothing && view.mean.size() != values) ||
        (need >= ViewNeed::MeanAndHalf && view.halfMean.size() != values))
        throw std::invalid_argument("the means of a block do not have its size");
}

// Pixels a side below which a block is too small for meaningful statistics.
inline constexpr int kSmallestVotingSide = 40;

// Weighs linear R, G and B (Rec. 709 primaries) in the luminance Y, with pbrt-v3's weights.

// They add up to 1, the luminance of white.
inline constexpr double kLuminanceWeights[3] = {0.212671, 0.715160, 0.072169};

inline float Luminance(float r, float g, float b) {
    return float(kLuminanceWeights[0]) * r + float(kLuminanceWeights[1]) * g +
           float(kLuminanceWeights[2]) * b;
}

}  // namespace lull
