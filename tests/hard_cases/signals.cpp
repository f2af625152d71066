// Blocks that are no pictures, and windows all but without change.
#include <fmt/format.h>

#include <cmath>

#include "stopping/features/model_inputs.h"
#include "stopping/rules/learned.h"
#include "stopping/rules/rule_table.h"
#include "tests/hard_cases/hard_case.h"
#include "tests/renderer/bsdf/sphere_statistics.h"
#include "tests/stopping/signals/block_images.h"

namespace lull {

namespace {

// One pixel of 10,000 flickers between two neighbouring 8-bit codes. No rule may wait for that:
// each stops as early as it can at all.
HardCaseResult Flicker(const HardCaseOptions&) {
    std::vector<HardCaseResult> results;
    const std::pair<const char*, int> earliest[] = {{"dammertz:0.02", 20},
                                                    {"cycles:0.01", 80},
                                                    {"luxtile:0.0234375", 40},
                                                    {"lnoise:0.5", 60},
                                                    {"entropy:0.64", 140}};
    for (const auto& [rule, spp] : earliest) {
        const auto criterion = MakeCriterion(ParseRule(rule));
        BlockImage block(100, 100, 0.18f);
        HardCaseResult result{double(spp), 10'000, 0, std::string("spp; worst: ") + rule};
        for (int now = 20; now <= 10'000; now += 20) {
            block.Mean(40, 60)[1] = now % 40 ? 0.18f : 0.184f;
            if (!criterion->Observe(block.At(now)).stop) continue;
            result.ours = now;
            break;
        }
        results.push_back(result);
    }
    return Worst(results);
}

// Returns a picture without noise: flat, a fine checkerboard, stripes or a random pattern, with a
// contrast of about 20 in lightness.
float Pattern(int kind, int x, int y) {
    const bool odd = kind == 1   ? (x + y) % 2
                     : kind == 2 ? x / 3 % 2
                                 : (unsigned(x * 7919 + y * 104729) * 2654435761u >> 31) != 0;
    return kind == 0 ? 0.2f : odd ? 0.3f : 0.15f;
}

// Texture alone is no noise, however fine it is: nothing falls.
HardCaseResult PureTexture(const HardCaseOptions&) {
    std::vector<HardCaseResult> results;
    for (const int side : {40, 200})
        for (int kind = 0; kind < 4; ++kind) {
            const auto criterion = MakeCriterion(ParseRule("entropy:0.64"));
            BlockImage block(side, side, 0);
            for (int y = 0; y < side; ++y)
                for (int x = 0; x < side; ++x)
                    std::fill_n(block.Mean(x, y), 3, Pattern(kind, x, y));
            block.halfMean = block.mean;
            HardCaseResult result{140, 10'000, 0, fmt::format("spp; pattern {}", kind)};
            for (int spp = 20; spp <= 1000; spp += 20) {
                if (!criterion->Observe(block.At(spp)).stop) continue;
                result.ours = spp;
                break;
            }
            results.push_back(result);
        }
    return Worst(results);
}

// Noise on it is seen as on a flat block, with the steps of 8 bits, which are 0.4 in lightness; in
// blocks of 40 pixels, whose sub-blocks have 4 x 4, fine texture makes it count more, but never
// less. The answer is its standard deviation in lightness when the rule stops.
HardCaseResult NoiseOnTexture(const HardCaseOptions& options) {
    std::vector<HardCaseResult> results;
    for (const int side : {40, 200})
        for (int kind = 0; kind < 4; ++kind) {
            const auto criterion = MakeCriterion(ParseRule("entropy:0.64"));
            test::Random random(unsigned(options.seed) + unsigned(kind));
            HardCaseResult result{0.4, 0, side == 200 ? 0.2 : 0.35,
                                  fmt::format("{} pixels, pattern {}", side, kind)};
            for (int spp = 20; spp <= 8020; spp += 40) {
                const double noise = 10 / std::sqrt(spp);
                BlockImage block(side, side, 0);
                for (int y = 0; y < side; ++y)
                    for (int x = 0; x < side; ++x) {
                        const double mean = Pattern(kind, x, y);
                        const double slope = 116 / 3.0 * std::pow(mean, -2 / 3.0);
                        // Uniform, of standard deviation 1.
                        const double draw = (random.Float() - 0.5) * std::sqrt(12);
                        std::fill_n(block.Mean(x, y), 3, float(mean + draw * noise / slope));
                    }
                block.halfMean = block.mean;  // no noise of few pixels
                if (!criterion->Observe(block.At(spp)).stop) continue;
                result.ours = noise;
                break;
            }
            results.push_back(result);
        }
    return Worst(results);
}

// The spread of a window is a last bit of the entropies: the normalised values stay in [0, 1].
HardCaseResult LastBitWindow(const HardCaseOptions&) {
    const ModelSettings settings{.k = 4};
    Failures outside;
    for (const double value : {1e-12, 0.1, 0.5, 0.999}) {
        History<double> history;
        for (int i = 0; i < 4; ++i)
            AddInputs(40 * (i + 1),
                      std::vector<double>(100, i % 2 ? value : std::nextafter(value, 2)), settings,
                      &history);
        const Eigen::MatrixXf window = *WindowOf(history, settings, 160);
        for (const float v : window.reshaped())
            outside.Note(!(v >= 0 && v <= 1), [&] { return fmt::format("{:g}", value); });
    }
    return outside.Result("values");
}

}  // namespace

std::vector<HardCase> SignalCases() {
    return {{"signals", "one pixel of 10,000 flickers by one 8-bit code",
             "a rule waits for ever for an invisible change", Flicker},
            {"signals", "pure texture before the rule entropy, blocks of 40 and 200 pixels",
             "fine detail taken for noise", PureTexture},
            {"signals",
             "noise on texture, 8-bit steps, blocks of 40 and 200 pixels: where entropy stops",
             "texture or rounding hides noise, or is taken for it", NoiseOnTexture},
            {"signals", "window of entropies that differ by their last bit",
             "values outside of [0, 1] by rounding", LastBitWindow}};
}

}  // namespace lull
