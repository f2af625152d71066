#include "stopping/lab/recordings/training_samples.h"

#include <gtest/gtest.h>

#include <stdexcept>

#include "stopping/features/block_memory.h"
#include "tests/stopping/lab/recordings/made_up_recordings.h"

namespace lull {
namespace {

TEST(JoinHuman, FindsRowsByTheirExactNames) {
    const std::vector<ViewpointRecording> viewpoints = {MakeViewpoint("a", 3, 400),
                                                        MakeViewpoint("b", 2, 400)};
    std::vector<std::string> unknown;
    const std::vector<LabelledBlock> blocks =
        JoinHuman(viewpoints, std::vector{MakeHumanRow("b"), MakeHumanRow("a-view0")}, &unknown);
    EXPECT_EQ(unknown, std::vector<std::string>{"a"});
    ASSERT_EQ(blocks.size(), 2u);
    EXPECT_EQ(blocks[1].viewpoint, "b");
    EXPECT_EQ(blocks[1].block, 1);
    EXPECT_EQ(blocks[1].human, 22 * 22);
    EXPECT_EQ(blocks[1].recording, &viewpoints[1].blocks.at(1));
}

TEST(JoinHuman, RefusesWhatDoesNotFit) {
    std::vector<ViewpointRecording> viewpoints = {MakeViewpoint("a", 1, 400),
                                                  MakeViewpoint("a", 1, 400)};
    const std::vector<ThresholdsRow> human = {MakeHumanRow("a"), MakeHumanRow("b")};
    EXPECT_THROW(JoinHuman(viewpoints, human, nullptr), std::invalid_argument);
    viewpoints[1].name = "b";
    EXPECT_NO_THROW(JoinHuman(viewpoints, human, nullptr));
    viewpoints[1].passSpp = 10;
    EXPECT_THROW(JoinHuman(viewpoints, human, nullptr), std::invalid_argument);
    viewpoints[1].passSpp = 20;
    viewpoints[1].blockCount = 4;
    EXPECT_THROW(JoinHuman(viewpoints, human, nullptr), std::invalid_argument);
}

TEST(MakeSamples, NeedTheAttributesOfEachBlock) {
    std::vector<ViewpointRecording> viewpoints = {MakeViewpoint("a", 3, 400)};
    viewpoints[0].blocks[1].absent.set(ChannelIndex("attributes26"));
    const std::vector<LabelledBlock> blocks =
        JoinHuman(viewpoints, std::vector{MakeHumanRow("a")}, nullptr);
    const ModelSettings settings = {.features = ParseFeatures("H,attributes26")};
    EXPECT_EQ(InputVector(MeasuresOf(*blocks[0].recording, 0, settings), settings).size(), 126u);
    EXPECT_THROW(MakeSamples(blocks, settings), std::invalid_argument);
}

TEST(MakeSamples, EndWindowsOnTheGrid) {
    const std::vector<ViewpointRecording> viewpoints = {MakeViewpoint("a", 2, 1000)};
    const std::vector<LabelledBlock> blocks =
        JoinHuman(viewpoints, std::vector{MakeHumanRow("a")}, nullptr);
    const TrainingSamples samples = MakeSamples(blocks, {});
    // 300, 340, ..., 980 spp of two blocks with the human thresholds 400 and 484.
    ASSERT_EQ(samples.Count(), 36u);
    EXPECT_EQ(samples.windowSize, 800);
    EXPECT_EQ(samples.windows.size(), 36u * 800);
    for (size_t i = 0; i < 36; ++i)
        EXPECT_EQ(int(samples.noisy[i]), 300 + 40 * int(i % 18) < (i < 18 ? 400 : 484)) << i;

    // They are the windows that a rule would see which looks at every recorded pass.
    History<double> history;
    const BlockRecording& recording = viewpoints[0].blocks.at(1);
    for (int i = 0, sample = 18; i < recording.Count(); ++i) {
        const int spp = recording.spp[size_t(i)];
        AddInputs(spp, InputVector(MeasuresOf(recording, i, {}), {}), {}, &history);
        if (spp < 300 || (spp - 20) % 40 != 0) continue;
        const Eigen::Map<const Eigen::MatrixXf> window(&samples.windows[size_t(sample++) * 800],
                                                       100, 8);
        EXPECT_TRUE(window == *WindowOf(history, {}, spp)) << spp;
    }
}

TEST(MakeSamples, RefusesWhatIsNotRecorded) {
    const std::vector<ViewpointRecording> viewpoints = {MakeViewpoint("a", 1, 1000)};
    const std::vector<LabelledBlock> blocks =
        JoinHuman(viewpoints, std::vector{MakeHumanRow("a")}, nullptr);
    for (int m : {4, 25, 400}) {
        EXPECT_EQ(MakeSamples(blocks, {.m = m}).windowSize, 8 * m);
        EXPECT_THROW(MakeSamples(blocks, {.m = m, .features = {Feature::H1}}),
                     std::invalid_argument);
    }
    EXPECT_NO_THROW(MakeSamples(blocks, {.features = {Feature::H1, Feature::H2}}));
    EXPECT_THROW(MakeSamples(blocks, {.m = 16}), std::invalid_argument);
    EXPECT_THROW(MakeSamples(blocks, {.n = 20}), std::invalid_argument);
    EXPECT_THROW(MakeSamples(blocks, {.n = 60}), std::invalid_argument);
    EXPECT_EQ(MakeSamples(blocks, {.k = 1, .n = 80}).Count(), 13u);
}

}  // namespace
}  // namespace lull
