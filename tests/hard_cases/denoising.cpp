// Pictures in which noise and detail are hard to tell apart.
#include <fmt/format.h>

#include "renderer/denoise/visible_error.h"
#include "renderer/vision/visible_difference.h"
#include "tests/hard_cases/hard_case.h"
#include "tests/renderer/denoise/example_pictures.h"

namespace lull {

namespace {

constexpr int kWidth = 120, kHeight = 100, kBorder = 12;
const PixelRect kWhole{{0, 0}, {kWidth, kHeight}};

using Truth = std::function<double(int x, int y)>;

// A picture in grey whose features see none of it.
struct HiddenPicture {
    Planes truth;
    NoisyPicture noisy;
    DenoisedPicture denoised;

    // `noise` is the standard deviation of a pixel of the mean of both halves.
    HiddenPicture(const Truth& value, double noise, uint64_t seed)
        : truth(MakePlanes(kWidth, kHeight, 3, [&](int, int x, int y) { return value(x, y); })),
          noisy(AddNoise(truth, FlatFeatures(kWidth, kHeight), noise * std::sqrt(2.0),
                         unsigned(seed))),
          denoised(Denoise(noisy)) {}
};

// Eight-bit displays show steps where a gradient is wrong by half a code.
HardCaseResult Gradient(const HardCaseOptions& o) {
    const HiddenPicture p([](int x, int) { return 0.2 + 0.0005 * x; }, 0.02, o.seed);
    double worst = 0;  // of the means of columns, in which noise has averaged out
    for (int x = kBorder; x < kWidth - kBorder; ++x) {
        double mean = 0;
        for (int y = 0; y < kHeight; ++y) mean += double(p.denoised.picture.Row(1, y)[x]) / kHeight;
        worst = std::max(worst, std::abs(mean - (0.2 + 0.0005 * x)));
    }
    return {0, worst, 0.004, "largest error of a column; a code is 0.0085 there"};
}

// The bound of what is visible, over textures and noise that the features do not see.
HardCaseResult Bound(const HardCaseOptions& o) {
    Failures above;
    for (const double noise : {0.1, 0.05, 0.025, 0.0125})
        for (const double texture : {0.0, 0.01, 0.03})
            for (uint64_t seed = o.seed; seed < o.seed + (o.isLong ? 20 : 3); ++seed) {
                const HiddenPicture p(
                    [&](int x, int y) {
                        return 0.4 + texture * std::sin(1.1 * x) * std::cos(0.7 * y);
                    },
                    noise, seed);
                const VisibleError said =
                    MeasureVisibleError(p.denoised, MeasureError(p.denoised), kWhole);
                const double truth = PooledDifference(
                    FindVisibleDifference(Interleaved(p.denoised.picture), Interleaved(p.truth),
                                          kWidth, kHeight, DisplayModel()));
                above.Note(truth > said.upper, [&] {
                    return fmt::format("noise {:g}, texture {:g}, seed {}", noise, texture, seed);
                });
            }
    return {0, double(above.count) / double(above.trials), 0.15,
            "share of images that are more wrong than the bound says"};
}

// The distance of a point from the line through (x0, y0) at an angle.
double FromLine(double x, double y, double x0, double y0, double angle) {
    return (y - y0) * std::cos(angle) - (x - x0) * std::sin(angle);
}

// Returns the share of a pattern on a grey wall that the denoised picture has, which is 1 if
// nothing is lost. `noise` is that of a pixel of the mean. Much of the contrast of wires and of the
// contact shadow is lost without RestoreStructure().
HardCaseResult Left(const std::function<double(double x, double y)>& pattern, double noise,
                    double tolerance, const HardCaseOptions& o) {
    constexpr int kPatternWidth = 140, kPatternHeight = 110, kPatternBorder = 10;
    constexpr double kPatternLevel = 0.3;
    const Planes truth = MakePlanes(kPatternWidth, kPatternHeight, 3, [&](int, int x, int y) {
        return kPatternLevel + pattern(x, y);
    });
    double left = 0;
    const int trials = o.isLong ? 8 : 2;
    for (int trial = 0; trial < trials; ++trial) {
        const Planes picture = Denoise(AddNoise(truth, FlatFeatures(kPatternWidth, kPatternHeight),
                                                noise * std::sqrt(2.0), unsigned(o.seed) + trial))
                                   .picture;
        double both = 0, whole = 0;
        for (int y = kPatternBorder; y < kPatternHeight - kPatternBorder; ++y)
            for (int x = kPatternBorder; x < kPatternWidth - kPatternBorder; ++x) {
                const double p = pattern(x, y);
                both += p * (double(picture.Row(1, y)[x]) - kPatternLevel);
                whole += p * p;
            }
        left += both / whole / trials;
    }
    return {1, left, tolerance, "share of its contrast that is left"};
}

HardCaseResult Wires(const HardCaseOptions& o) {
    return Left(
        [](double x, double y) {
            double wires = 0;
            for (const double angle : {0.15, 0.8, 1.45})
                wires += std::abs(FromLine(x, y, 70, 55, angle)) < 0.7;
            return wires > 0 ? -0.12 : 0;
        },
        0.04, 0.45, o);
}

HardCaseResult ContactShadow(const HardCaseOptions& o) {
    return Left(
        [](double x, double y) {
            const double below = FromLine(x, y, 70, 50, 0.1);
            return below > 0 ? -0.1 * std::exp(-below / 3) : 0;
        },
        0.0375, 0.38, o);
}

}  // namespace

std::vector<HardCase> DenoisingCases() {
    return {
        {"denoising", "a gradient of a code every 17 pixels", "bands", Gradient},
        {"denoising", "how wrong it may still be, without a reference",
         "blocks stop that are smeared", Bound},
        {"denoising", "wires 1 pixel wide, 3 times as strong as the noise", "melts away", Wires},
        {"denoising", "a contact shadow, 2.7 times as strong as the noise", "melts away",
         ContactShadow}};
}

}  // namespace lull
