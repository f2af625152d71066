// Compares guided samples with unguided ones: how noisy they are, and how long their paths.
#pragma once

#include <span>
#include <vector>

#include "renderer/film/film.h"

namespace lull {

// Returns the mean luminance of the image so far.
double MeanLuminance(const Film&);

// Guided relative to unguided samples.
struct GuideComparison {
    double variance = 1;  // of a sample: the square of the ratio of noise, see below
    double error = 0;     // standard error of that
    double vertices = 1;  // of a path
};

// Standard deviations of a sample of a tile, in lightness; both 0 where there are not samples of
// both kinds, and where the display is saturated.
struct TileNoise {
    float unguided = 0, guided = 0;
};

// Samples of both kinds, tile by tile, as the film has tiles.
struct GuideTally {
    std::vector<SampleSpread> unguided, guided;

    // Returns the noise of each tile.
    std::vector<TileNoise> Noise(const Film&) const;
    // Compares all tiles, whose noise is `noise`. It counts as its mean over tiles, of both kinds:
    // so the few where fireflies are do not decide.
    GuideComparison Compare(std::span<const TileNoise> noise) const;
};

// Returns the variance of guided samples over that of unguided ones in a part of the film, with the
// tiles `noise`, plus its standard error: in (0, 1], and 1 where fewer than kTilesEnough tiles have
// an estimate.
double VarianceOf(std::span<const TileNoise> noise, const Film&, const PixelRect& part);
inline constexpr int kTilesEnough = 8;

}  // namespace lull
