#include "stopping/lab/recordings/extension.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include "stopping/lab/evaluation/simulation.h"
#include "tests/stopping/lab/recordings/made_up_recordings.h"

namespace lull::extension_test {
namespace {

// Returns the recording as it was when it had `end` spp.
BlockRecording CutAt(const BlockRecording& recording, int end) {
    BlockRecording cut = recording;
    const auto first = std::ranges::upper_bound(cut.spp, end);
    cut.values.resize(size_t(first - cut.spp.begin()) * kRecordLength);
    cut.spp.erase(first, cut.spp.end());
    for (int& stop : cut.cyclesStops)
        if (stop > end) stop = 0;
    return cut;
}

LabelledBlock BlockOf(const BlockRecording& recording) {
    return {.viewpoint = "room", .block = 0, .human = 1000, .passSpp = 20, .recording = &recording};
}

TEST(Extension, GoesOnByTheLawsOfTheNumbers) {
    BlockRecording whole = EmptyRecording(kMostShownSpp);
    SetChannel(&whole, "h100", [](int spp) { return 0.3 + 5 * std::pow(spp, -0.9); });
    SetChannel(&whole, "masked_noise", [](int spp) { return 9 / std::sqrt(spp); });
    SetChannel(&whole, "deviation", [](int spp) { return std::sqrt(4 + 300.0 / spp); });
    SetChannel(&whole, "lightness", [](int) { return 42; });
    whole.absent.set(ChannelIndex("attributes26"));
    whole.cyclesStops = {40, 160, 640};
    const BlockRecording cut = CutAt(whole, 1000);
    const BlockRecording extended = ExtendRecording(cut, 20, kMostShownSpp);

    EXPECT_EQ(extended.spp, whole.spp);
    EXPECT_TRUE(std::equal(cut.values.begin(), cut.values.end(), extended.values.begin()));
    ASSERT_EQ(extended.values.size(), whole.values.size());
    for (size_t i = cut.values.size(); i < whole.values.size(); ++i)
        EXPECT_NEAR(extended.values[i], whole.values[i], 1e-4) << i % kRecordLength;
    EXPECT_EQ(extended.absent, whole.absent);
    // T^2 n is kept: with the least threshold that had stopped, 0.16, at 640 spp.
    for (size_t i = 3; i < kCyclesThresholds.size(); ++i) {
        const double ratio = kCyclesThresholds[2] / kCyclesThresholds[i];
        const double spp = 640 * ratio * ratio;
        if (spp > kMostShownSpp)
            EXPECT_EQ(extended.cyclesStops[i], 0) << i;
        else
            EXPECT_NEAR(extended.cyclesStops[i], std::max(spp, 1020.0), 20) << i;
    }
}

TEST(Extension, TakesShortRecordings) {
    for (const int end : {20, 40, 60}) {
        BlockRecording recording = EmptyRecording(end);
        SetChannel(&recording, "masked_noise", [](int spp) { return 9 / std::sqrt(spp); });
        SetChannel(&recording, "h100", [](int) { return 0.5; });
        const BlockRecording extended = ExtendRecording(recording, 20, 900);
        EXPECT_EQ(extended.spp.back(), 900);
        EXPECT_NEAR(extended.Values(extended.Count() - 1, "masked_noise")[7], 0.3, 1e-5);
        EXPECT_NEAR(extended.Values(extended.Count() - 1, "h100")[7], 0.5, 1e-5);
    }
    EXPECT_THROW(ExtendRecording(BlockRecording(), 20, 900), std::invalid_argument);
}

TEST(Extension, LeavesWholeRecordingsAsTheyAre) {
    const BlockRecording whole = EmptyRecording(kMostShownSpp), part = EmptyRecording(500);
    const std::vector<LabelledBlock> blocks = {BlockOf(part), BlockOf(whole)};
    const ExtendedBlocks extended = ExtendBlocks(blocks);
    ASSERT_EQ(extended.blocks.size(), 2u);
    EXPECT_EQ(extended.recordings.size(), 1u);
    EXPECT_EQ(extended.blocks[0].recording->spp, whole.spp);
    EXPECT_EQ(extended.blocks[1].recording, &whole);
}

// How stops predicted from the first part of recordings compare with those that are.
struct Prediction {
    double mean = 0, deviation = 0;  // of the ratio
    int count = 0;
};

Prediction PredictFrom(double share, const Simulator& rule) {
    double sum = 0, squares = 0;
    int count = 0;
    for (const char* name : {"living-room-view0", "contemporary-bathroom"})
        for (const ViewpointRecording& viewpoint :
             ReadDataset(LULL_SOURCE_DIR "/stopping/data/" + std::string(name) + ".h5"))
            for (const auto& [number, recording] : viewpoint.blocks) {
                const int stop = rule(BlockOf(recording)).stop;
                const BlockRecording cut = CutAt(recording, int(share * stop));
                EXPECT_TRUE(rule(BlockOf(cut)).open);
                const BlockRecording extended = ExtendRecording(cut, 20, kMostShownSpp);
                const double ratio = rule(BlockOf(extended)).stop / double(stop);
                sum += ratio;
                squares += ratio * ratio;
                ++count;
            }
    const double mean = sum / count;
    return {mean, std::sqrt(squares / count - mean * mean), count};
}

TEST(Extension, PredictsTheStopsOfWholeRecordings) {
    const Simulator rule = MakeSimulator("entropy");
    const Prediction half = PredictFrom(0.5, rule), more = PredictFrom(0.67, rule);
    EXPECT_EQ(half.count, 12);
    EXPECT_NEAR(half.mean, 0.95, 0.03);
    EXPECT_LT(half.deviation, 0.09);
    EXPECT_NEAR(more.mean, 0.98, 0.02);
    EXPECT_LT(more.deviation, 0.07);  // peak noise is extrapolated, too
}

}  // namespace
}  // namespace lull::extension_test
