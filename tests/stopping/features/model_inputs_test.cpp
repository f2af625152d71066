#include "stopping/features/model_inputs.h"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>

#include "stopping/lab/recordings/training_samples.h"
#include "stopping/rules/learned.h"
#include "tests/stopping/network/random_network.h"
#include "tests/stopping/signals/block_images.h"

namespace lull {
namespace {

TEST(ModelSettings, NameFeatures) {
    const std::string features = "H,H1,H2,visible_drop,attributes26";
    EXPECT_EQ(FeatureNames(ParseFeatures(features)), features);
    for (const char* bad : {"", "H3", "H,", ",H", "H,H", "h", "H noise", "texture"})
        EXPECT_THROW(ParseFeatures(bad), std::invalid_argument) << bad;
}

TEST(InputVector, TakesTheMeanBeforeItScales) {
    BlockMeasures measures{.spp = 10000};
    for (int i = 0; i < 100; ++i) {
        measures.Of(Feature::H).push_back(i / 100.0);
        measures.Of(Feature::VisibleDrop).push_back(i);
    }
    const std::vector<double> x =
        InputVector(measures, {.features = {Feature::H, Feature::VisibleDrop}, .takesMean = true});
    ASSERT_EQ(x.size(), 2u);
    EXPECT_NEAR(x[0], 0.495, 1e-12);
    EXPECT_NEAR(x[1], std::log(49.6), 1e-12);
}

TEST(InputVector, GivesEachSubBlock) {
    const ModelSettings settings = {.m = 4, .features = {Feature::H, Feature::VisibleDrop}};
    const std::vector<InputRange> ranges = InputRanges(settings);
    ASSERT_EQ(ranges.size(), 2u);
    EXPECT_EQ(ranges[0].begin, 0);
    EXPECT_EQ(ranges[1].begin, 4);
    EXPECT_EQ(InputCount(settings), 104);

    BlockMeasures measures{.spp = 20};
    measures.Of(Feature::H) = {0.1, 0.2, 0.3, 0.4};
    measures.Of(Feature::VisibleDrop).assign(100, 1);
    const std::vector<double> x = InputVector(measures, settings);
    EXPECT_EQ(x[2], 0.3);
    EXPECT_NEAR(x[103], std::log(1.1), 1e-6);
    measures.Of(Feature::H).pop_back();
    EXPECT_THROW(InputVector(measures, settings), std::invalid_argument);
}

TEST(Window, NormalisesEntropiesOnly) {
    const ModelSettings settings{
        .k = 2, .n = 20, .features = {Feature::VisibleDrop, Feature::H}, .takesMean = true};
    History<double> history;
    AddInputs(20, {0.1, 0.2}, settings, &history);
    AddInputs(40, {0.3, 0.6}, settings, &history);
    Eigen::MatrixXf expected(2, 2);
    expected << 0.1f, 0.3f, 0, 1;
    EXPECT_TRUE(WindowOf(history, settings, 40)->isApprox(expected, 1e-6f));
}

TEST(Window, NormalisesAttributesAsEntropies) {
    const ModelSettings settings = {
        .k = 2, .n = 20, .m = 1, .features = ParseFeatures("attributes26,H"), .takesMean = true};
    ASSERT_EQ(InputCount(settings), 27);  // of attributes there is no mean
    History<double> history;
    for (const int spp : {20, 40}) {
        BlockMeasures measures{.spp = spp};
        for (int i = 0; i < 26; ++i) measures.Of(Feature::Attributes26).push_back(spp + i);
        measures.Of(Feature::H) = {0.5};
        AddInputs(spp, InputVector(measures, settings), settings, &history);
    }
    const Eigen::MatrixXf window = *WindowOf(history, settings, 40);
    for (int step = 0; step < 2; ++step)
        for (int i = 0; i < 26; ++i) EXPECT_NEAR(window(i, step), step, 1e-6);
    EXPECT_EQ(window(26, 1), 0);
}

// Training inputs, from a recording, must equal those in a render.
TEST(ModelInputs, AreThoseOfRecordings) {
    for (int m : {25, 100}) {
        ModelSettings settings = {.m = m};
        settings.features = ParseFeatures(m == 100 ? "H,H1,H2,attributes26" : "H,attributes26");
        BlockRecording recording;
        BlockRecorder recorder(20, 100, 100, &recording);
        for (int spp = 20; spp <= 100; spp += 20) {
            const BlockImage block = NoisyBlock(64, 60, 0.5, spp, unsigned(spp));
            recorder.Observe(block.At(spp));
            const std::vector<double> live =
                InputVector(MeasureBlock(block.At(spp), settings), settings);
            const std::vector<double> recorded =
                InputVector(MeasuresOf(recording, spp / 20 - 1, settings), settings);
            ASSERT_EQ(recorded.size(), live.size());
            for (size_t i = 0; i < live.size(); ++i)
                EXPECT_NEAR(recorded[i], live[i], 1e-6 * std::max(1.0, live[i]));
        }
    }
}

}  // namespace
}  // namespace lull
