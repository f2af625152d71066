// Blocks that are no pictures, windows without change and networks without measure.
#include <fmt/format.h>

#include <cmath>
#include <filesystem>
#include <limits>

#include "stopping/features/model_inputs.h"
#include "stopping/rules/learned.h"
#include "stopping/rules/rule_table.h"
#include "stopping/signals/svd_entropy.h"
#include "tests/hard_cases/hard_case.h"
#include "tests/renderer/bsdf/sphere_statistics.h"
#include "tests/renderer/files/test_files.h"
#include "tests/stopping/network/random_network.h"
#include "tests/stopping/signals/block_images.h"

namespace lull {

namespace {

using Lightness = Eigen::Matrix<double, 20, 20, Eigen::RowMajor>;

// Returns the entropy of two singular values out of 20.
double EntropyOfTwo(long double s1, long double s2) {
    const long double q = (s2 / s1) * (s2 / s1), p1 = 1 / (1 + q), p2 = q / (1 + q);
    const long double h1 = p1 * std::log1p(q);  // -p1 log p1 without cancellation
    return double((h1 - (p2 > 0 ? p2 * std::log(p2) : 0)) / std::log(20.0L));
}

HardCaseResult FlatBlocks(const HardCaseOptions&) {
    std::vector<HardCaseResult> results;
    const auto add = [&](const Lightness& block, const std::string& name) {
        results.push_back({0, ComputeSvdEntropy(block).h, 1e-13, "worst: " + name});
    };
    for (const double value : {0.0, 1e-300, 1e-3, 50.0, 100.0})
        add(Lightness::Constant(value), fmt::format("constant {:g}", value));
    Lightness firefly = Lightness::Zero();
    firefly(7, 13) = 100;
    add(firefly, "firefly on black");
    add(Eigen::Matrix<double, 20, 1>::LinSpaced(1, 100) *
            Eigen::Matrix<double, 1, 20>::LinSpaced(0.3, 1),
        "product of two ramps");
    return Worst(results);
}

// A board of m + d and m - d is m times ones and d times signs: singular values 20 m and 20 d.
HardCaseResult Checkerboards(const HardCaseOptions&) {
    std::vector<HardCaseResult> results;
    for (const double d : {50.0, 10.0, 0.4, 1e-3, 1e-6}) {
        Lightness board;
        for (int y = 0; y < 20; ++y)
            for (int x = 0; x < 20; ++x) board(y, x) = 50 + ((x + y) % 2 ? d : -d);
        results.push_back({EntropyOfTwo(50, d), ComputeSvdEntropy(board).h, 1e-13,
                           fmt::format("worst: difference {:g}", 2 * d)});
    }
    return Worst(results);
}

// A constant c with one pixel of c + d on the diagonal: a matrix of rank two, whose eigenvalues
// have the sum 20 c + d and the product 19 c d.
HardCaseResult OneBit(const HardCaseOptions&) {
    std::vector<HardCaseResult> results;
    for (const double d : {50.0, 0.4, 1e-3, 1e-6}) {
        const long double c = 50, trace = 20 * c + d, product = 19 * c * d;
        const long double large = (trace + std::sqrt(trace * trace - 4 * product)) / 2;
        Lightness block = Lightness::Constant(double(c));
        block(3, 3) += d;
        results.push_back({EntropyOfTwo(large, product / large), ComputeSvdEntropy(block).h, 1e-13,
                           fmt::format("worst: difference {:g}", d)});
    }
    return Worst(results);
}

std::shared_ptr<const Model> RandomModel(float range, unsigned seed) {
    return std::make_shared<const Model>(
        Model{RandomNetwork(100, {32, 16}, range, seed), {.k = 4}, ""});
}

// Shows blocks to every rule that looks at them; all answers have to be numbers in their range.
void ObserveAll(const BlockImage& block, const std::string& name, Failures* failures) {
    std::vector<std::unique_ptr<Criterion>> criteria;
    for (const char* rule :
         {"dammertz:0.02", "cycles:0.01", "luxtile:0.0234375", "lnoise:0.5", "entropy:0.64"})
        criteria.push_back(MakeCriterion(ParseRule(rule)));
    for (const float range : {0.1f, 1.f, 1e4f})
        criteria.push_back(MakeCriterion(LearnedRule(RandomModel(range, 1), 20)));
    for (size_t i = 0; i < criteria.size(); ++i)
        for (int spp = 20; spp <= 200; spp += 20) {
            const Decision d = criteria[i]->Observe(block.At(spp));
            const double most = i < 5 ? std::numeric_limits<double>::max() : 1;
            failures->Note(!(d.value >= 0 && d.value <= most),
                           [&] { return fmt::format("{}, rule {}, {} spp", name, i, spp); });
            if (d.stop) break;
        }
}

HardCaseResult AnySignal(const HardCaseOptions&) {
    Failures failures;
    for (const float value : {0.f, 1e-38f, 0.18f, 1.f, 1e9f, 3e38f}) {
        BlockImage block(100, 100, value);
        ObserveAll(block, fmt::format("constant {:g}", value), &failures);
        block.Mean(31, 17)[0] = block.HalfMean(31, 17)[0] = 1e9f;
        ObserveAll(block, fmt::format("firefly on {:g}", value), &failures);
        for (int y = 0; y < 100; ++y)
            for (int x = 0; x < 100; ++x) block.HalfMean(x, y)[1] *= (x + y) % 2 ? 0.5f : 1.5f;
        ObserveAll(block, fmt::format("checkerboard of noise on {:g}", value), &failures);
    }
    return failures.Result("answers");
}

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

const ModelSettings kFourSteps{.k = 4};

HardCaseResult ConstantWindow(const HardCaseOptions&) {
    std::vector<HardCaseResult> results;
    for (const double value : {0.0, 1e-12, 0.5, 1.0}) {
        History<double> history;
        for (int spp = 40; spp <= 160; spp += 40)
            AddInputs(spp, std::vector<double>(100, value), kFourSteps, &history);
        results.push_back({0, double(WindowOf(history, kFourSteps, 160)->cwiseAbs().maxCoeff()), 0,
                           fmt::format("worst: entropies of {:g}", value)});
    }
    return Worst(results);
}

// The spread of a window is a last bit of the entropies: the normalised values stay in [0, 1].
HardCaseResult LastBitWindow(const HardCaseOptions&) {
    Failures outside;
    for (const double value : {1e-12, 0.1, 0.5, 0.999}) {
        History<double> history;
        for (int i = 0; i < 4; ++i)
            AddInputs(40 * (i + 1),
                      std::vector<double>(100, i % 2 ? value : std::nextafter(value, 2)),
                      kFourSteps, &history);
        const Eigen::MatrixXf window = *WindowOf(history, kFourSteps, 160);
        for (const float v : window.reshaped())
            outside.Note(!(v >= 0 && v <= 1), [&] { return fmt::format("{:g}", value); });
    }
    return outside.Result("values");
}

HardCaseResult HugeWeights(const HardCaseOptions& options) {
    Failures failures;
    for (int trial = 0; trial < (options.isLong ? 10'000 : 200); ++trial) {
        const unsigned seed = unsigned(options.seed) + unsigned(trial);
        const Network network = RandomNetwork(100, {32, 16}, 1e4f, seed);
        test::Random random(seed);
        const Eigen::MatrixXf window =
            Eigen::MatrixXf::NullaryExpr(100, 8, [&] { return random.Float(); });
        const double p = NoisyProbability(network, window);
        failures.Note(!(p >= 0 && p <= 1), [&] { return fmt::format("seed {}", seed); });
    }
    return failures.Result("networks");
}

// Writes a model and damages one of its weights, with all kinds of weights that are no numbers.
HardCaseResult BrokenWeights(const HardCaseOptions&) {
    const TemporaryDirectory directory;
    const float marker = 0.123456789f;
    Failures accepted;
    for (const float broken : {std::nanf(""), std::numeric_limits<float>::infinity(),
                               -std::numeric_limits<float>::infinity()})
        for (int array = 0; array < 5; ++array) {
            Network network = RandomNetwork(100, {4}, 1);
            Eigen::Ref<Eigen::MatrixXf> weights = [&]() -> Eigen::Ref<Eigen::MatrixXf> {
                if (array == 0) return network.lstm[0].kernel;
                if (array == 1) return network.lstm[0].recurrent;
                if (array == 2) return network.lstm[0].bias;
                if (array == 3) return network.dense[0].kernel;
                return network.dense[0].bias;
            }();
            weights(0, 0) = marker;
            WriteModel(directory.File("m.h5"), network, {});
            std::string bytes = ReadBytes(directory.File("m.h5"));
            const std::string_view pattern(reinterpret_cast<const char*>(&marker), 4);
            const size_t at = bytes.find(pattern);
            bool refused = false;
            if (at != std::string::npos) {
                bytes.replace(at, 4, reinterpret_cast<const char*>(&broken), 4);
                try {
                    ReadModel(directory.Write("m.h5", bytes));
                } catch (const std::runtime_error&) {
                    refused = true;
                }
            }
            accepted.Note(!refused, [&] { return fmt::format("{} in array {}", broken, array); });
        }
    return accepted.Result("models");
}

}  // namespace

std::vector<HardCase> SignalCases() {
    return {{"signals", "entropy of black, constant, firefly and ramp blocks",
             "0 log 0; rounding taken for noise", FlatBlocks},
            {"signals", "entropy of checkerboards, contrast 100 to 2e-6",
             "small singular values drown in rounding", Checkerboards},
            {"signals", "entropy of one pixel that differs by 50 to 1e-6",
             "small singular values drown in rounding", OneBit},
            {"signals", "every rule on black, saturated, firefly and checkered blocks",
             "NaN that is below every threshold, or never", AnySignal},
            {"signals", "one pixel of 10,000 flickers by one 8-bit code",
             "a rule waits for ever for an invisible change", Flicker},
            {"signals", "pure texture before the rule entropy, blocks of 40 and 200 pixels",
             "fine detail taken for noise", PureTexture},
            {"signals",
             "noise on texture, 8-bit steps, blocks of 40 and 200 pixels: where entropy stops",
             "texture or rounding hides noise, or is taken for it", NoiseOnTexture},
            {"signals", "window of equal entropies", "0/0 in the normalisation", ConstantWindow},
            {"signals", "window of entropies that differ by their last bit",
             "values outside of [0, 1] by rounding", LastBitWindow},
            {"signals", "networks with weights of 1e4", "overflow of exp gives NaN", HugeWeights},
            {"signals", "models with NaN or infinite weights",
             "a broken model stops everything, or nothing", BrokenWeights}};
}

}  // namespace lull
