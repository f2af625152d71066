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

    // Returns how many times as wrong the denoised picture is as the mean of the samples.
    double ErrorRatio() const {
        return Rms(denoised.picture, truth, kBorder) / Rms(MeanOf(noisy.colour), truth, kBorder);
    }
};

HardCaseResult PureNoise(const HardCaseOptions& o) {
    std::vector<HardCaseResult> results;
    for (const double noise : {0.2, 0.05, 0.01, 0.001})
        results.push_back(
            {0, HiddenPicture([](int, int) { return 0.4; }, noise, o.seed).ErrorRatio(), 0.25,
             fmt::format("error left, of that of the samples; worst: noise {:g}", noise)});
    return Worst(results);
}

// Texture of single pixels, as strong as the noise of the mean: there is nothing to be gained, and
// half of the energy to be lost.
HardCaseResult TextureLikeNoise(const HardCaseOptions& o) {
    std::vector<HardCaseResult> results;
    for (const double noise : {0.05, 0.02, 0.005}) {
        std::mt19937 generator(unsigned(o.seed + 1000));
        std::normal_distribution<double> gauss(0, noise);
        const HiddenPicture p([&](int, int) { return 0.4 + gauss(generator); }, noise, o.seed);
        results.push_back({0, std::max(0.0, p.ErrorRatio() - 1), 0.1,
                           fmt::format("worse than the samples; worst: noise {:g}", noise)});
    }
    return Worst(results);
}

HardCaseResult ThinEdges(const HardCaseOptions& o) {
    const auto isLine = [](int x) { return x == 60; };
    const HiddenPicture p([&](int x, int) { return isLine(x) ? 0.7 : 0.4; }, 0.02, o.seed);
    double line = 0, beside = 0;
    for (int y = 0; y < kHeight; ++y) {
        const float* row = p.denoised.picture.Row(1, y);
        line += double(row[60]);
        beside += double(row[58] + row[62]) / 2;
    }
    return {0.3, (line - beside) / kHeight, 0.03, "contrast of a line one pixel wide"};
}

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

HardCaseResult SingleFireflies(const HardCaseOptions& o) {
    std::vector<HardCaseResult> results;
    for (const float brightness : {10.f, 100.f, 1e6f}) {
        NoisyPicture noisy = HiddenPicture([](int, int) { return 0.4; }, 0.05, o.seed).noisy;
        for (int c = 0; c < 3; ++c) noisy.colour.a.Row(c, 50)[60] = brightness;
        const DenoisedPicture denoised = Denoise(noisy);
        const std::string note = fmt::format("worst: brightness {:g}", double(brightness));
        if (brightness > 1e4f) {  // not all of it is returned, and the rest counts as error
            const double upper =
                MeasureVisibleError(denoised, MeasureError(denoised), kWhole).upper;
            results.push_back({0, double(upper < 1), 0, "clean without its light; " + note});
            continue;
        }
        results.push_back({1, SumOf(denoised.picture) / SumOf(MeanOf(noisy.colour)), 0.01,
                           "energy kept; " + note});
        results.push_back(
            {0,
             double(denoised.picture.Row(1, 50)[60]) / double(denoised.picture.Row(1, 50)[40]) - 1,
             0.15, "brighter than 20 pixels beside; " + note});
    }
    return Worst(results);
}

HardCaseResult Extremes(const HardCaseOptions& o) {
    Failures failures;
    for (const double level : {0.0, 1e-30, 1e-6, 1.0, 1e6, 1e30})
        for (const double noise : {0.0, 0.1, 10.0}) {
            HiddenPicture p([&](int, int) { return level; }, level * noise, o.seed);
            bool failed = false;
            for (const float v : p.denoised.picture.values) failed |= !(v >= 0 && v < HUGE_VALF);
            const VisibleError error =
                MeasureVisibleError(p.denoised, MeasureError(p.denoised), kWhole);
            failed |= !(error.estimate >= 0 && error.upper >= error.estimate);
            failed |= !(error.upper < HUGE_VAL);
            failures.Note(failed,
                          [&] { return fmt::format("level {:g}, noise {:g}", level, noise); });
        }
    return failures.Result("pictures that have to be numbers, not negative");
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
            "share of pictures that are more wrong than the bound says"};
}

}  // namespace

std::vector<HardCase> DenoisingCases() {
    return {
        {"denoising", "pure noise, 0.2 to 0.001 on 0.4", "blotches", PureNoise},
        {"denoising", "texture of single pixels, as strong as the noise", "texture is smeared away",
         TextureLikeNoise},
        {"denoising", "a line one pixel wide that no feature sees", "thin edges fade", ThinEdges},
        {"denoising", "a gradient of a code every 17 pixels", "bands", Gradient},
        {"denoising", "single fireflies, 25 to 2.5 million times as bright",
         "blobs, or light that is lost", SingleFireflies},
        {"denoising", "black, white, 1e-30 and 1e30", "NaN, negative light", Extremes},
        {"denoising", "how wrong it may still be, without a reference",
         "blocks stop that are smeared", Bound}};
}

}  // namespace lull
