#include "stopping/lab/training/training.h"

#include <gtest/gtest.h>

#include <stdexcept>

#include "stopping/base/parallel.h"
#include "stopping/lab/evaluation/evaluation.h"
#include "stopping/rules/learned.h"
#include "tests/stopping/cut_states.h"
#include "tests/stopping/lab/recordings/made_up_recordings.h"

namespace lull {
namespace {

// Samples of a made-up viewpoint together with it.
struct Data {
    std::vector<ViewpointRecording> viewpoints = {MakeViewpoint("a", 4, 1500)};
    TrainingSamples samples;

    explicit Data(const ModelSettings& settings)
        : samples(MakeSamples(JoinHuman(viewpoints, std::vector{MakeHumanRow("a")}, nullptr),
                              settings)) {}
};

ModelSettings SmallSettings() { return {.k = 3, .m = 25}; }

TrainingOptions SmallOptions() { return {.units = {12, 6}, .batch = 40, .epochs = 3, .seed = 5}; }

std::vector<float> Flat(const Network& network) {
    std::vector<float> all;
    auto add = [&](const auto& a) { all.insert(all.end(), a.data(), a.data() + a.size()); };
    for (const LstmLayer& l : network.lstm) add(l.kernel), add(l.recurrent), add(l.bias);
    for (const DenseLayer& l : network.dense) add(l.kernel), add(l.bias);
    return all;
}

Network Train(const TrainingSamples& samples, const TrainingOptions& options) {
    Trainer trainer(samples, options);
    while (!trainer.IsDone()) trainer.Step();
    return trainer.Result();
}

TEST(Trainer, GivesTheSameWeightsOnAnyNumberOfThreads) {
    const Data data(SmallSettings());
    Network networks[3];
    for (int i = 0; i < 3; ++i)
        RunWithThreads(i == 2 ? 8 : i + 1,
                       [&] { networks[i] = Train(data.samples, SmallOptions()); });
    EXPECT_EQ(Flat(networks[0]), Flat(networks[1]));
    EXPECT_EQ(Flat(networks[0]), Flat(networks[2]));
    TrainingOptions other = SmallOptions();
    other.seed = 6;
    EXPECT_NE(Flat(networks[0]), Flat(Train(data.samples, other)));
}

TEST(Trainer, GoesOnAsIfNeverInterrupted) {
    const Data data(SmallSettings());
    Trainer whole(data.samples, SmallOptions());
    for (int steps = 0; !whole.IsDone(); ++steps) {
        Trainer rest(data.samples, SmallOptions());
        rest.Restore(whole.Save());
        whole.Step();
        rest.Step();
        EXPECT_EQ(Flat(whole.Result()), Flat(rest.Result())) << steps;
        EXPECT_EQ(whole.Save(), rest.Save()) << steps;
        EXPECT_EQ(whole.Progress().auc, rest.Progress().auc);
    }
    EXPECT_EQ(Flat(whole.Result()), Flat(Train(data.samples, SmallOptions())));
}

TEST(Trainer, RefusesTheStateOfAnotherTraining) {
    const Data data(SmallSettings()), otherData({.k = 2, .m = 25});
    Trainer trainer(data.samples, SmallOptions());
    trainer.Step();
    const std::vector<std::byte> state = trainer.Save();
    EXPECT_THROW(Trainer(otherData.samples, SmallOptions()).Restore(state), std::runtime_error);
    TrainingOptions other = SmallOptions();
    other.dropout = 0.3;
    EXPECT_THROW(Trainer(data.samples, other).Restore(state), std::runtime_error);
    ExpectRefusesCut(state, 997,
                     [&](auto cut) { Trainer(data.samples, SmallOptions()).Restore(cut); });
}

TEST(Trainer, TellsHowFarItIs) {
    const Data data(SmallSettings());
    Trainer trainer(data.samples, SmallOptions());
    const int64_t count = int64_t(data.samples.Count());
    EXPECT_EQ(trainer.Progress().samples, 0);
    EXPECT_EQ(trainer.Progress().allSamples, 3 * count);
    trainer.Step();
    EXPECT_EQ(trainer.Progress().samples, 40);
    while (!trainer.IsDone()) trainer.Step();
    EXPECT_EQ(trainer.Progress().samples, 3 * count);
    EXPECT_EQ(trainer.Progress().epoch, 3);
    EXPECT_GT(trainer.Progress().loss, 0);
}

// Returns the area under the curve of a network's answers to samples.
double AucOf(const Network& network, const TrainingSamples& samples) {
    std::vector<float> answers;
    for (size_t i = 0; i < samples.Count(); ++i) {
        const Eigen::Map<const Eigen::MatrixXf> window(
            &samples.windows[i * size_t(samples.windowSize)],
            samples.windowSize / samples.settings.k, samples.settings.k);
        answers.push_back(float(NoisyProbability(network, window)));
    }
    return AreaUnderRoc(answers, samples.noisy);
}

TEST(Trainer, LearnsWhatNoiseIs) {
    const Data data({.k = 2, .features = {Feature::H}, .takesMean = true, .snorm = false});
    const TrainingOptions options = {
        .units = {8}, .dropout = 0, .learningRate = 0.01, .epochs = 30};
    EXPECT_GT(AucOf(Train(data.samples, options), data.samples), 0.99);
}

TEST(Trainer, LetsEachViewpointCountTheSame) {
    // Two viewpoints that contradict each other: the one with more blocks must not decide.
    TrainingSamples samples{
        .settings = {.k = 1, .features = {Feature::VisibleDrop}, .takesMean = true},
        .windowSize = 1};
    auto add = [&](int viewpoint, char noisy, int count) {
        for (int i = 0; i < count; ++i) {
            samples.windows.push_back(viewpoint == 0 ? 1.f : -1.f);
            samples.noisy.push_back(noisy);
            samples.viewpoint.push_back(viewpoint);
        }
    };
    add(0, 1, 300);
    add(0, 0, 100);
    add(1, 1, 5);
    add(1, 0, 20);
    TrainingOptions options = {
        .units = {4}, .dropout = 0, .learningRate = 0.01, .batch = 425, .epochs = 400};
    const auto probability = [&](float input) {
        return NoisyProbability(Train(samples, options), Eigen::MatrixXf::Constant(1, 1, input));
    };
    EXPECT_GT(probability(1), 0.51);
    EXPECT_LT(probability(-1), 0.2);
    options.balanceViewpoints = true;
    EXPECT_NEAR(probability(1), 0.5, 0.02);
    EXPECT_NEAR(probability(-1), 0.5, 0.02);
    // With one viewpoint an input, the learned values are the fractions of their noisy samples.
    options.balanceClasses = false;
    EXPECT_NEAR(probability(1), 0.75, 0.02);
    EXPECT_NEAR(probability(-1), 0.2, 0.02);
    options.balanceViewpoints = false;
    EXPECT_NEAR(probability(1), 0.75, 0.02);
}

TEST(Trainer, RefusesWhatCannotBeLearned) {
    const Data data(SmallSettings());
    TrainingSamples same = data.samples;
    std::fill(same.noisy.begin(), same.noisy.end(), char(1));
    EXPECT_THROW(Trainer(same, SmallOptions()), std::invalid_argument);
    EXPECT_THROW(Trainer(data.samples, {.units = {4}, .batch = 0}), std::invalid_argument);
    EXPECT_THROW(Trainer(data.samples, {.units = {4}, .dropout = 1}), std::invalid_argument);
    EXPECT_THROW(Trainer(data.samples, {.units = {0}}), std::invalid_argument);

    TrainingOptions wild = SmallOptions();
    wild.learningRate = 1e38;
    EXPECT_THROW(Train(data.samples, wild), std::runtime_error);
}

}  // namespace
}  // namespace lull
