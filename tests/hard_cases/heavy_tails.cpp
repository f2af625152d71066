#include "tests/hard_cases/heavy_tails.h"

#include <fmt/format.h>

#include <cmath>

#include "renderer/film/film.h"
#include "stopping/rules/rule_table.h"
#include "tests/hard_cases/hard_case.h"
#include "tests/renderer/bsdf/sphere_statistics.h"

namespace lull {

namespace {

constexpr int kSide = 100, kCap = 10'000, kPass = 20;
constexpr double kMean = 0.25;

// Gives the samples of a tail: a bell-like sum of three even numbers, and seldom the rare light.
struct TailSource {
    explicit TailSource(const Tail& tail, uint64_t seed)
        : random(seed),
          rarity(float(tail.rarity)),
          rare(tail.rarity > 0 ? float(kMean * tail.share / tail.rarity) : 0),
          common(float(kMean * (1 - tail.share))),
          width(float(2 * tail.spread) * common) {}

    float Next(bool* sawRare) {
        const float bell = random.Float() + random.Float() + random.Float() - 1.5f;
        *sawRare = random.Float() < rarity;
        // Where the spread is wide that leaves negative samples, as filters do.
        return common + width * bell + (*sawRare ? rare : 0);
    }

    test::Random random;
    float rarity, rare, common, width;
};

StopOutcome OutcomeOf(const std::vector<FilmPixel>& pixels, const std::vector<char>& seen) {
    StopOutcome outcome{.spp = int(pixels[0].count)};
    double sum = 0, squares = 0;
    for (size_t i = 0; i < pixels.size(); ++i) {
        const double relative = pixels[i].sum[0] / pixels[i].count / kMean - 1;
        sum += relative;
        squares += relative * relative;
        outcome.unseen += !seen[i];
    }
    const double n = double(pixels.size());
    outcome.bias = sum / n;
    outcome.error = std::sqrt(squares / n);
    outcome.unseen /= n;
    return outcome;
}

}  // namespace

std::vector<Tail> HeavyTails() {
    return {{"mild noise", 0, 0, 0.5},
            {"strong noise", 0, 0, 2},
            {"rare light: 1 path in 200 carries half", 1.0 / 200, 0.5, 0.5},
            {"fireflies: 1 path in 5,000 carries a fifth", 1.0 / 5000, 0.2, 0.5}};
}

std::vector<std::string> UsualRules() {
    return {"dammertz:0.02", "cycles:0.01", "luxtile:0.0234375", "lnoise:0.5", "entropy:0.64"};
}

std::vector<StopOutcome> StopBlocks(const Tail& tail, const std::vector<std::string>& rules,
                                    uint64_t seed) {
    TailSource source(tail, seed);
    std::vector<FilmPixel> pixels(kSide * kSide);
    std::vector<char> seen(pixels.size(), 0);
    std::vector<float> mean(3 * pixels.size()), halfMean(mean.size());
    std::vector<std::unique_ptr<Criterion>> criteria;
    for (const std::string& rule : rules)
        criteria.push_back(MakeCriterion(ParseRule(rule, {.passSpp = kPass})));
    std::vector<StopOutcome> outcomes(rules.size());
    size_t live = rules.size();
    for (int spp = kPass; spp <= kCap && live > 0; spp += kPass) {
        for (size_t i = 0; i < pixels.size(); ++i) {
            for (int k = 0; k < kPass; ++k) {
                bool sawRare;
                pixels[i].Add(Rgb::Constant(source.Next(&sawRare)), false);
                seen[i] |= sawRare;
            }
            const Rgb all = pixels[i].Mean(), half = pixels[i].HalfMean();
            for (int c = 0; c < 3; ++c) {
                mean[3 * i + size_t(c)] = all[c];
                halfMean[3 * i + size_t(c)] = half[c];
            }
        }
        for (size_t r = 0; r < rules.size(); ++r) {
            if (!criteria[r]) continue;
            const Decision decision = criteria[r]->Observe({kSide, kSide, spp, mean, halfMean});
            if (!decision.stop && spp < kCap) continue;
            outcomes[r] = OutcomeOf(pixels, seen);
            criteria[r].reset();
            --live;
        }
    }
    return outcomes;
}

// The mean over 10,000 pixels is known to 0.07 % at 10,000 spp of the rare light and to 0.2 % at
// 1,000, so that a bias of 1 % is one.
std::vector<HardCase> HeavyTailCases() {
    return {{"heavy tails", "rare light, 1 path in 200 carries half",
             "rules stop just where the rare light is still missing",
             [](const HardCaseOptions& options) {
                 const std::vector<std::string> rules = UsualRules();
                 const std::vector<StopOutcome> stops =
                     StopBlocks(HeavyTails()[2], rules, options.seed);
                 std::vector<HardCaseResult> results;
                 for (size_t i = 0; i < rules.size(); ++i)
                     results.push_back(
                         {0, stops[i].bias, 0.01,
                          fmt::format("bias; worst: {}, stops at {} spp, {:.2g} % of pixels have "
                                      "not seen it",
                                      rules[i], stops[i].spp, 100 * stops[i].unseen)});
                 return Worst(results);
             }}};
}

}  // namespace lull
