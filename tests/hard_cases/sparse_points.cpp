// Blocks in which few pixels have nearly all noise: thin lights and fireflies. A mean over a block
// does not see them, people see them first.
#include <fmt/format.h>

#include "stopping/rules/rule_table.h"
#include "stopping/signals/lightness.h"
#include "stopping/signals/lightness_noise.h"
#include "tests/hard_cases/hard_case.h"
#include "tests/renderer/bsdf/sphere_statistics.h"

namespace lull {

namespace {

constexpr int kBlockSide = 100, kMostSpp = 4000, kPassSpp = 20;
constexpr double kHitRate = 0.02;  // of the paths of a point, those that find its light
constexpr double kContrast = 30;   // of a point, in L*
// Peak noise that may be left: that which rules accept, 1.6, as halves estimate it.
constexpr double kAccepted = 2.4;

// Samples of a block of even lightness with mild noise, in which some pixels see a light.
class PointsBlock {
  public:
    PointsBlock(double lightness, int points, uint64_t seed)
        : random(seed),
          base(float(LuminanceOf(lightness))),
          light(float((LuminanceOf(std::min(100.0, lightness + kContrast)) - base) / kHitRate)),
          isPoint(kBlockSide * kBlockSide),
          sums(isPoint.size()),
          halfSums(isPoint.size()) {
        for (int placed = 0; placed < points;) {
            char& point = isPoint[size_t(random.Below(int(isPoint.size())))];
            placed += !point;
            point = 1;
        }
    }

    void AddPass() {
        for (size_t i = 0; i < sums.size(); ++i)
            for (int half = 0; half < 2; ++half) {
                float sum = base * (kPassSpp / 2) * (1 + 0.02f * (random.Float() - 0.5f));
                for (int k = 0; isPoint[i] && k < kPassSpp / 2; ++k)
                    sum += random.Float() < kHitRate ? light : 0;
                sums[i] += sum;
                if (half == 1) halfSums[i] += sum;
            }
        spp += kPassSpp;
    }

    // Returns means of grey pixels.
    std::vector<float> Mean() const { return Grey(sums, spp); }
    std::vector<float> HalfMean() const { return Grey(halfSums, spp / 2.0); }
    std::vector<float> Truth() const {
        std::vector<float> values;
        for (const char point : isPoint) values.push_back(base + (point ? light * kHitRate : 0));
        return Grey(values, 1);
    }

    int spp = 0;

  private:
    static std::vector<float> Grey(const std::vector<float>& values, double divisor) {
        std::vector<float> grey;
        for (const float v : values) grey.insert(grey.end(), 3, float(v / divisor));
        return grey;
    }

    test::Random random;
    float base, light;
    std::vector<char> isPoint;
    std::vector<float> sums, halfSums;
};

// Returns the root of the mean fourth power of the error that is left where a rule stops.
HardCaseResult ErrorAtStop(const std::string& rule, double lightness, int points, uint64_t seed) {
    PointsBlock block(lightness, points, seed);
    const auto criterion = MakeCriterion(ParseRule(rule, {.passSpp = kPassSpp}));
    Decision decision;
    while (!decision.stop && block.spp < kMostSpp) {
        block.AddPass();
        const std::vector<float> mean = block.Mean(), half = block.HalfMean();
        decision = criterion->Observe({kBlockSide, kBlockSide, block.spp, mean, half});
    }
    const std::vector<float> mean = block.Mean(), truth = block.Truth();
    LightnessNoise error = ComputeLightnessNoise({kBlockSide, kBlockSide, block.spp, mean, truth});
    const std::vector<float> right = DisplayedLightness(truth);
    for (size_t i = 0; i < right.size(); ++i) error.halfNoise[i] = error.lightness[i] - right[i];
    return {0, PeakNoise(error), kAccepted,
            fmt::format("L* RMS of fourth powers; worst: {} points at L* {:g}, stops at {} spp",
                        points, lightness, block.spp)};
}

HardCaseResult WorstOfPoints(const std::string& rule, const HardCaseOptions& options) {
    std::vector<HardCaseResult> results;
    for (const double lightness : {2.0, 10.0, 35.0, 80.0})
        for (const int points : {1, 10, 100, 1000})
            results.push_back(ErrorAtStop(rule, lightness, points, options.seed));
    return Worst(results);
}

}  // namespace

std::vector<HardCase> SparsePointCases() {
    std::vector<HardCase> cases;
    for (const char* rule : {"entropy:0.64", "lnoise:0.65"})
        cases.push_back(
            {"sparse points", std::string("thin lights, 1 to 1,000 pixels: ") + rule,
             "a mean over the block misses what observers see first",
             [rule](const HardCaseOptions& options) { return WorstOfPoints(rule, options); }});
    return cases;
}

}  // namespace lull
