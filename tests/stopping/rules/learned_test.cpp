#include "stopping/rules/learned.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <stdexcept>
#include <vector>

#include "stopping/base/block_view.h"
#include "stopping/network/model_file.h"
#include "stopping/rules/rule_table.h"
#include "tests/stopping/network/random_network.h"
#include "tests/stopping/scratch_file.h"
#include "tests/stopping/signals/block_images.h"

namespace lull {
namespace {

// Returns a network that answers the same for every input.
Network ConstantNetwork(int m, float probability) {
    Network network = RandomNetwork(m, {3}, 0.1f);
    network.dense[0].kernel.setZero();
    network.dense[0].bias[0] = std::log(probability / (1 - probability));
    return network;
}

std::shared_ptr<const Model> MakeModel(Network network, const ModelSettings& settings) {
    return std::make_shared<const Model>(Model{std::move(network), settings, ""});
}

// Shows the criterion pass after pass of a block that converges; returns its decisions up to
// `end` spp or the one that stops.
std::vector<Decision> RunPasses(Criterion* criterion, int first, int end, int passSpp = 20) {
    std::vector<Decision> decisions;
    for (int spp = first; spp <= end; spp += passSpp) {
        const BlockImage block = NoisyBlock(40, 40, 0.5, spp, unsigned(spp));
        decisions.push_back(criterion->Observe(block.At(spp)));
        if (decisions.back().stop) break;
    }
    return decisions;
}

TEST(Learned, StopsFirstAt380SppOnThePapersGrid) {
    const auto model = MakeModel(ConstantNetwork(100, 0.1f), {.voteSpacing = 40});
    const auto criterion = MakeCriterion(LearnedRule(model, 20));
    EXPECT_EQ(criterion->Need(20), ViewNeed::Mean);
    EXPECT_EQ(criterion->Need(40), ViewNeed::Nothing);
    const std::vector<Decision> decisions = RunPasses(criterion.get(), 20, 10000);
    ASSERT_EQ(decisions.size(), 19u);  // passes
    for (size_t i = 0; i < decisions.size(); ++i) {
        const int spp = 20 * int(i + 1);
        const bool checked = spp == 300 || spp == 340 || spp == 380;
        EXPECT_EQ(decisions[i].checked, checked) << spp;
        EXPECT_EQ(decisions[i].votes, spp < 300 ? 0 : (spp - 260) / 40) << spp;
        EXPECT_NEAR(decisions[i].value, spp < 300 ? 1 : 0.1, 1e-6);
        EXPECT_EQ(decisions[i].threshold, 0.5);
    }
}

TEST(Learned, StopsFirstAt340SppWithAVoteEachPass) {
    const auto model = MakeModel(ConstantNetwork(100, 0.1f), {});
    EXPECT_EQ(RunPasses(MakeCriterion(LearnedRule(model, 20)).get(), 20, 10000).size(), 17u);
}

TEST(Learned, ChecksWhatVotesLookBackTo) {
    const auto checked = [](int n, int voteSpacing, int passSpp = 20) {
        const auto model =
            MakeModel(ConstantNetwork(100, 0.1f), {.n = n, .voteSpacing = voteSpacing});
        const Checks checks = LearnedRule(model, passSpp).checks;
        std::vector<int> spp;
        for (int i = 1; i <= 120; ++i)
            if (checks.AreDue(i)) spp.push_back(i);
        return spp;
    };
    EXPECT_EQ(checked(40, 0), (std::vector<int>{20, 40, 60, 80, 100, 120}));
    EXPECT_EQ(checked(40, 40), (std::vector<int>{20, 60, 100}));
    EXPECT_EQ(checked(40, 80), (std::vector<int>{20, 60, 100}));
    EXPECT_EQ(checked(60, 40), (std::vector<int>{20, 40, 60, 80, 100, 120}));
    EXPECT_EQ(checked(40, 0, 0), (std::vector<int>{40, 80, 120}));  // pictures at any spp
}

TEST(Learned, NeverStopsOnNoise) {
    const auto model = MakeModel(ConstantNetwork(25, 0.9f), {.m = 25});
    const auto decisions = RunPasses(MakeCriterion(LearnedRule(model, 20)).get(), 20, 1000);
    EXPECT_EQ(decisions.size(), 50u);
    EXPECT_EQ(decisions.back().votes, 0);
}

// Returns a block of 2 x 2 sub-blocks of 20 x 20 pixels, black but for the first pixels of their
// diagonals, which are white: as many as `ranks` says. These are the singular values, all equal, so
// that the SVD-entropy is log(rank) / log(20).
BlockImage DiagonalBlock(const std::array<int, 4>& ranks) {
    BlockImage image(40, 40, 0);
    for (int i = 0; i < 4; ++i)
        for (int d = 0; d < ranks[size_t(i)]; ++d)
            std::fill_n(image.Mean(20 * (i % 2) + d, 20 * (i / 2) + d), 3, 1.f);
    return image;
}

TEST(Learned, VotesOnTheWindowOfItsFeatures) {
    const ModelSettings settings = {.k = 3, .n = 40, .m = 4, .votes = 1000};
    const Network network = RandomNetwork(4, {5}, 1, 3);
    const auto criterion = MakeCriterion(LearnedRule(MakeModel(network, settings), 20));

    std::vector<std::array<int, 4>> ranks;  // of all passes
    for (int spp = 20; spp <= 200; spp += 20) {
        std::array<int, 4>& rank = ranks.emplace_back();
        for (int i = 0; i < 4; ++i) rank[size_t(i)] = 1 + (7 * (spp / 20) + 5 * i) % 20;
        const Decision decision = criterion->Observe(DiagonalBlock(rank).At(spp));
        ASSERT_EQ(decision.checked, spp >= 100);
        if (!decision.checked) continue;
        // The states at spp - 80, spp - 40 and spp, each sub-block from 0 to 1 over them.
        Eigen::MatrixXf window(4, 3);
        for (size_t i = 0; i < 4; ++i) {
            double h[3];
            for (size_t step = 0; step < 3; ++step)
                h[step] = std::log(ranks[ranks.size() - 5 + 2 * step][i]) / std::log(20.0);
            const auto [least, most] = std::minmax({h[0], h[1], h[2]});
            for (int step = 0; step < 3; ++step)
                window(Eigen::Index(i), step) = float((h[step] - least) / (most - least));
        }
        EXPECT_NEAR(decision.value, NoisyProbability(network, window), 1e-6) << spp;
    }
}

// Returns settings of a model that looks at the visible noise of `k` states and never stops.
ModelSettings DropSettings(int k) {
    return {.k = k,
            .features = {Feature::VisibleDrop},
            .takesMean = true,
            .votes = 1000,
            .voteSpacing = 40,
            .spacing = Spacing::Geometric,
            .ratio = 1.5};
}

// Returns a network that is undecided where the last input is `limit`.
Network LastStepNetwork(double limit) {
    LstmLayer lstm{"lstm_1", Eigen::MatrixXf::Zero(4, 1), Eigen::MatrixXf::Zero(4, 1),
                   Eigen::Vector4f(10, -10, float(-3 * limit), 10)};
    lstm.kernel(2, 0) = 3;
    // At the limit the cell is 1/2, and the output the sigmoid of that.
    return {.lstm = {lstm},
            .dense = {{"dense_1", Eigen::MatrixXf::Constant(1, 1, 20),
                       Eigen::VectorXf::Constant(1, float(-20 / (1 + std::exp(-0.5))))}}};
}

TEST(Learned, KnowsTheNoiseAtWhichItIsUndecided) {
    ModelSettings settings = DropSettings(2);
    const auto undecided = [&](const Network& network) {
        return UndecidedNoise({network, settings, ""});
    };
    EXPECT_NEAR(undecided(LastStepNetwork(std::log(0.7 + 0.1))), 0.7, 1e-3);
    // A network that is never sure, or never unsure, or that sees something else.
    EXPECT_EQ(undecided(ConstantNetwork(1, 0.1f)), 0);
    EXPECT_EQ(undecided(ConstantNetwork(1, 0.9f)), 0);
    settings.features = {Feature::VisibleDrop, Feature::H};
    EXPECT_EQ(undecided(ConstantNetwork(2, 0.5f)), 0);
    settings.features = {Feature::H};
    EXPECT_EQ(undecided(LastStepNetwork(0)), 0);
}

// It reports the noise by which it decides.
TEST(Learned, SaysWhatNoiseItWasTold) {
    ModelSettings settings = DropSettings(2);
    settings.caution = 1.3;
    const Model model{LastStepNetwork(std::log(2 + 0.1)), settings, ""};
    const double limit = UndecidedNoise(model);
    const auto criterion = MakeCriterion(LearnedRule(std::make_shared<const Model>(model), 20));
    int noisy = 0, clean = 0;
    for (int spp = 20; spp <= 4000; spp += 20) {
        const BlockImage block = NoisyBlock(40, 40, 0.5, spp, unsigned(spp));
        const Decision decision = criterion->Observe(block.At(spp));
        if (!decision.checked) continue;
        const auto noise = criterion->NetworkNoise();
        ASSERT_TRUE(noise);
        EXPECT_EQ(*noise >= limit, decision.value >= 0.5) << *noise;
        ++(decision.value >= 0.5 ? noisy : clean);
    }
    EXPECT_GT(noisy, 5);
    EXPECT_GT(clean, 5);
}

// Only noise that is followed is known to saturate and to vanish at the reference; odds are not.
TEST(Learned, SaysHowWhatIsFollowedFalls) {
    const ScratchFile file(".h5");
    ModelSettings settings = DropSettings(2);
    WriteModel(file.path, LastStepNetwork(std::log(0.7 + 0.1)), settings);
    const RuleTrend noise = ParseRule("learned:" + file.path).trend;
    EXPECT_NEAR(noise.undecided, 0.7, 1e-3);
    EXPECT_EQ(noise.reference, settings.visibility.reference);
    EXPECT_EQ(noise.nearness, settings.visibility.nearness);
    EXPECT_TRUE(noise.saturates);
    settings.features = {Feature::VisibleDrop, Feature::H};
    WriteModel(file.path, ConstantNetwork(2, 0.5f), settings);
    const RuleTrend odds = ParseRule("learned:" + file.path).trend;
    EXPECT_EQ(odds.undecided, 0);
    EXPECT_EQ(odds.reference, 0);
    EXPECT_FALSE(odds.saturates);
}

TEST(Learned, SurvivesAnyBlock) {
    const ModelSettings settings = {.k = 2, .m = 25, .features = ParseFeatures("H,attributes26")};
    const float infinity = std::numeric_limits<float>::infinity();
    for (const auto& model : {MakeModel(RandomNetwork(25, {8, 4}, 1e4f), {.k = 3, .m = 25}),
                              MakeModel(RandomNetwork(InputCount(settings), {4}, 10), settings)})
        for (const float value : {0.f, 1.f, 1e30f, -1.f, infinity, -infinity,
                                  std::numeric_limits<float>::quiet_NaN()}) {
            const auto criterion = MakeCriterion(LearnedRule(model, 20));
            const BlockImage block(41, 57, value);
            for (int spp = 20; spp <= 200; spp += 20) {
                const Decision decision = criterion->Observe(block.At(spp));
                EXPECT_TRUE(decision.value >= 0 && decision.value <= 1) << value;
            }
        }
}

TEST(Learned, TakesNonsenseForNoise) {
    Network network = RandomNetwork(4, {2}, 1);
    network.lstm[0].activation = network.dense[0].activation = Activation::Linear;
    network.lstm[0].kernel.setConstant(3e38f);
    network.dense[0].kernel << 3e38f, -3e38f;
    EXPECT_EQ(NoisyProbability(network, Eigen::MatrixXf::Ones(4, 8)), 1);
}

TEST(Learned, RefusesModelsThatDoNotFit) {
    const Network good = RandomNetwork(25, {4}, 1);
    EXPECT_NO_THROW(MakeCriterion(LearnedRule(MakeModel(good, {.m = 25}), 20)));
    EXPECT_NO_THROW(MakeCriterion(LearnedRule(MakeModel(good, {.m = 25}), 10)));
    EXPECT_THROW(MakeCriterion(LearnedRule(MakeModel(good, {.m = 100}), 20)),
                 std::invalid_argument);
    EXPECT_THROW(MakeCriterion(LearnedRule(MakeModel(good, {.m = 25}), 16)), std::invalid_argument);
    EXPECT_THROW(MakeCriterion(LearnedRule(MakeModel(good, {.m = 25, .voteSpacing = 30}), 20)),
                 std::invalid_argument);
    Network outputs = good;
    outputs.dense.clear();
    EXPECT_THROW(MakeCriterion(LearnedRule(MakeModel(outputs, {.m = 25}), 20)),
                 std::invalid_argument);
}

TEST(Learned, WantsTheSppToIncrease) {
    const auto model = MakeModel(RandomNetwork(25, {4}, 1), {.m = 25});
    const auto criterion = MakeCriterion(LearnedRule(model, 20));
    const BlockImage block(40, 40, 0.5f);
    criterion->Observe(block.At(40));
    EXPECT_THROW(criterion->Observe(block.At(40)), std::invalid_argument);
    EXPECT_THROW(criterion->Observe(block.At(20)), std::invalid_argument);
    BlockView empty = block.At(60);
    empty.mean = {};
    EXPECT_THROW(criterion->Observe(empty), std::invalid_argument);
}

// Runs a rule over blocks whose noise falls; returns the decisions up to a stop.
std::vector<Decision> Decide(Criterion* rule, int end) {
    std::vector<Decision> decisions;
    for (int spp = 20; spp <= end; spp += 20) {
        const BlockImage block = NoisyBlock(100, 100, 0.2, spp, unsigned(spp));
        BlockView view = block.At(spp);
        view.halfMean = {};  // it is not needed
        if (rule->Need(spp) == ViewNeed::Nothing) view.mean = {};
        decisions.push_back(rule->Observe(view));
        if (decisions.back().stop) break;
    }
    return decisions;
}

TEST(EntropyRule, StopsAfterThreeChecksInARow) {
    const auto rule = MakeCriterion(EntropyRule(1.5, {}, 20));
    const std::vector<Decision> decisions = Decide(rule.get(), 4000);
    const int stop = 20 * int(decisions.size());
    ASSERT_TRUE(decisions.back().stop);
    EXPECT_EQ((stop - 20) % 40, 0);
    EXPECT_GT(stop, 140);
    EXPECT_LT(stop, 4000);
    EXPECT_EQ(decisions.back().votes, 3);
    EXPECT_EQ(decisions.back().threshold, 1.5);
    for (size_t i = 0; i < decisions.size(); ++i) {
        EXPECT_EQ(decisions[i].checked, i >= 2 && i % 2 == 0) << i;
        EXPECT_TRUE(i < 2 || decisions[i].value > 0);
        if (i + 1 < decisions.size()) {
            EXPECT_FALSE(decisions[i].stop);
        }
    }
    for (const size_t back : {1, 3, 5}) EXPECT_LT(decisions[decisions.size() - back].value, 1.5);
    EXPECT_GE(decisions[decisions.size() - 7].value, 1.5);
}

TEST(EntropyRule, NeedsFourTimesTheSamplesForHalfOfTheThreshold) {
    const NoiseVisibility visibility{.reference = 1 << 30};
    const auto spp = [&](double threshold) {
        return 20.0 *
               double(Decide(MakeCriterion(EntropyRule(threshold, visibility, 20)).get(), 9000)
                          .size());
    };
    const double once = spp(0.8), half = spp(0.4);
    EXPECT_NEAR(half / once, 4, 0.8);
}

TEST(EntropyRule, ChecksWhereRecordingsHavePasses) {
    const Checks checks = EntropyChecks(20);
    for (const int spp : {20, 60, 100, 420, 9980}) EXPECT_TRUE(checks.AreDue(spp)) << spp;
    for (const int spp : {40, 80, 400, 10000}) EXPECT_FALSE(checks.AreDue(spp)) << spp;
    EXPECT_TRUE(EntropyChecks(1).AreDue(1));
    EXPECT_FALSE(EntropyChecks(1).AreDue(2));
    EXPECT_TRUE(EntropyChecks(1).AreDue(41));
    EXPECT_TRUE(EntropyChecks(100).AreDue(200));
}

TEST(EntropyRule, IsARule) {
    const Rule factory = ParseRule("entropy:0.5");
    EXPECT_EQ(factory.text, "entropy:0.5");
    EXPECT_EQ(factory.smallestSide, kSmallestVotingSide);
    const auto rule = MakeCriterion(factory);
    EXPECT_EQ(rule->Need(20), ViewNeed::MeanAndHalf);
    EXPECT_EQ(MakeCriterion(ParseRule("entropy", {.hasHalves = false}))->Need(20), ViewNeed::Mean);
    EXPECT_EQ(rule->Need(40), ViewNeed::Nothing);
    EXPECT_TRUE(ParseRule("entropy").text.starts_with("entropy:0."));
    EXPECT_THROW(ParseRule("entropy:0"), std::invalid_argument);
    EXPECT_THROW(ParseRule("entropy:"), std::invalid_argument);
    EXPECT_THROW(rule->Observe(BlockImage(9, 40, 0.5f).At(20)), std::invalid_argument);
}

TEST(EntropyRule, ComparesWithThePictureAtALargerCap) {
    const auto valueAt = [](int cap) {
        const auto rule =
            MakeCriterion(ParseRule("entropy:0.01", {.cap = cap, .hasHalves = false}));
        return Decide(rule.get(), 1020).back().value;
    };
    const double standard = valueAt(0);
    EXPECT_EQ(valueAt(10000), standard);
    EXPECT_EQ(valueAt(6000), standard);
    EXPECT_NEAR(valueAt(1 << 24) / standard, 1 / std::sqrt(1 - 0.102), 1e-3);
}

TEST(EntropyRule, SurvivesAnyBlock) {
    const float infinity = std::numeric_limits<float>::infinity();
    for (const float value :
         {0.f, 1.f, 1e30f, -1.f, infinity, -infinity, std::numeric_limits<float>::quiet_NaN()}) {
        const auto rule = MakeCriterion(EntropyRule(0.6, {}, 20));
        const BlockImage block(41, 57, value);
        int stop = 0;
        for (int spp = 20; spp <= 200 && stop == 0; spp += 20) {
            const Decision decision = rule->Observe(block.At(spp));
            EXPECT_TRUE(decision.value >= 0 && std::isfinite(decision.value)) << value;
            if (decision.stop) stop = spp;
        }
        EXPECT_EQ(stop, 140) << value;
    }
}

}  // namespace
}  // namespace lull
