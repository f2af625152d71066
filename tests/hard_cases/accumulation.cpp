// Sums of thousands of samples of all magnitudes.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "renderer/film/film.h"
#include "tests/hard_cases/hard_case.h"
#include "tests/renderer/bsdf/sphere_statistics.h"

namespace lull {

namespace {

constexpr int kSamples = 10'000;

// Returns values from 1e-6 to 1e6, even in their logarithms.
std::vector<float> Values(uint64_t seed) {
    test::Random random(seed);
    std::vector<float> values(kSamples);
    for (float& v : values) v = std::pow(10.f, 12 * random.Float() - 6);
    return values;
}

// Returns by what share of it the pixel's sum differs from that in long double.
double SumError(const std::vector<float>& values, bool ofHalf) {
    FilmPixel pixel;
    long double exact = 0;
    for (uint32_t i = 0; i < values.size(); ++i) {
        pixel.Add(Rgb::Constant(values[i]), false);
        if (!ofHalf || InHalf(i)) exact += values[i];
    }
    const double ours = ofHalf ? pixel.halfSum[1] : pixel.sum[1];
    return double(std::abs(ours - exact) / exact);
}

HardCaseResult Sums(const HardCaseOptions& options) {
    std::vector<HardCaseResult> results;
    for (int trial = 0; trial < (options.isLong ? 1000 : 10); ++trial) {
        std::vector<float> values = Values(options.seed + uint64_t(trial));
        const auto add = [&](const char* order) {
            for (const bool ofHalf : {false, true})
                results.push_back({0, SumError(values, ofHalf), 1e-9,
                                   fmt::format("relative; worst: {}, seed {}", order,
                                               options.seed + uint64_t(trial))});
        };
        add("as they come");
        std::ranges::sort(values);
        add("ascending");
        std::ranges::reverse(values);
        add("descending");
    }
    return Worst(results);
}

// One firefly of 1e9, and then 10,000 samples of 1e-6 that single precision would not notice.
HardCaseResult AfterAFirefly(const HardCaseOptions&) {
    FilmPixel pixel;
    pixel.Add(Rgb::Constant(1e9f), false);
    for (int i = 0; i < kSamples; ++i) pixel.Add(Rgb::Constant(1e-6f), false);
    return {0.01, pixel.sum[1] - 1e9, 1e-3, "added to 1e9"};
}

// The mean of equal samples is that sample, however many there are.
HardCaseResult EqualSamples(const HardCaseOptions&) {
    std::vector<HardCaseResult> results;
    for (const float value : {0.1f, 1e-38f, 3e38f}) {
        FilmPixel pixel;
        for (int i = 0; i < kSamples; ++i) pixel.Add(Rgb::Constant(value), false);
        results.push_back(
            {1, double(pixel.Mean()[1]) / value, 1.2e-7, fmt::format("worst: {:g}", value)});
        results.push_back(
            {1, double(pixel.HalfMean()[1]) / value, 1.2e-7, fmt::format("worst: {:g}", value)});
    }
    return Worst(results);
}

}  // namespace

std::vector<HardCase> AccumulationCases() {
    return {{"accumulation", "10,000 samples from 1e-6 to 1e6, in any order",
             "sums in single precision stop growing", Sums},
            {"accumulation", "10,000 samples of 1e-6 after one of 1e9",
             "the dark samples after a firefly are lost", AfterAFirefly},
            {"accumulation", "mean of 10,000 equal samples, 1e-38 to 3e38",
             "overflow of sums; drift of running means", EqualSamples}};
}

}  // namespace lull
