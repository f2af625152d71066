// Decides whether samples as was learned pay: compares them with samples without, in how noisy they
// are, how long their paths are, and what they cost.
#pragma once

#include <span>
#include <vector>

#include "renderer/film/film.h"
#include "stopping/base/state.h"

namespace lull {

// Costs of what is learned, relative to that without.
struct LearningCosts {
    double guidedVertex = 1.2;  // 1.05 to 1.45 in 16 scenes at 128x128 pixels
    // Of a sample, where there is an environment map, and where there are lights alone: finding the
    // probabilities, and shadow rays that are no longer occluded early.
    double environment = 1.25, lights = 1.15;
    // Of a light path, and of a subpath from a light with its connections, in camera's subpaths
    // with the light that is sampled at their vertices (renderer/docs/transport.md).
    double lightPath = 1, connections = 2.5;
};
inline constexpr LearningCosts kCosts;

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
// an estimate, as where there are none.
double VarianceOf(std::span<const TileNoise> noise, const Film&, const PixelRect& part);
inline constexpr int kTilesEnough = 8;

// Variance times work is significantly below that without; above; or neither.
enum class Verdict { Pays, DoesNotPay, Open };

struct Trial {
    GuideTally tally;              // while it is under way
    std::vector<TileNoise> noise;  // of the tiles, where it has paid
    GuideComparison comparison;

    void Begin(const Film&);
    // Compares; samples cost `perVertex` for each of their vertices, or `perSample`, whichever is
    // not 0. If that leaves it open, the next samples as was learned are compared alone.
    Verdict Decide(const Film&, double perSample, double perVertex);
    // Forgets the samples.
    void End() { tally = {}; }

    void Put(StateWriter*) const;
    // Throws std::runtime_error(damaged), or (foreign) unless it `isUnderWay`, or has paid, for so
    // many tiles.
    void Get(StateReader*, bool isUnderWay, bool pays, size_t tiles, const char* damaged,
             const char* foreign);
};

}  // namespace lull
