// Recordings of pictures, which come at any spp and have no halves.
#include <gtest/gtest.h>

#include <stdexcept>

#include "stopping/lab/evaluation/rivals.h"
#include "stopping/lab/evaluation/simulation.h"
#include "stopping/lab/recordings/extension.h"
#include "stopping/lab/recordings/labelled_blocks.h"
#include "stopping/rules/rule_table.h"
#include "tests/stopping/scratch_file.h"
#include "tests/stopping/signals/block_images.h"
#include "tests/stopping/what_of.h"

namespace lull::picture_records_test {
namespace {

BlockRecording Record(const std::vector<int>& spp, double noise = 0.5) {
    BlockRecording recording;
    for (const int n : spp) AddPicture(NoisyBlock(40, 40, noise, n, unsigned(n)).At(n), &recording);
    return recording;
}

LabelledBlock Labelled(const BlockRecording& recording, const char* viewpoint = "room") {
    return {.viewpoint = viewpoint,
            .human = 300,
            .cap = recording.spp.back(),
            .passSpp = 0,
            .recording = &recording};
}

TEST(PictureRecords, AreThoseOfTheMean) {
    const BlockImage image = NoisyBlock(40, 40, 0.5, 20, 1);
    BlockRecording whole, picture;
    BlockRecorder(20, 20, 20, &whole).Observe(image.At(20));
    BlockView view = image.At(20);
    view.halfMean = {};
    AddPicture(view, &picture);
    for (const Channel& channel : kChannels) {
        if (picture.absent[ChannelIndex(channel.name)]) continue;
        EXPECT_TRUE(
            std::ranges::equal(picture.Values(0, channel.name), whole.Values(0, channel.name)))
            << channel.name;
    }
    EXPECT_EQ(picture.absent.count(), 6u);
    EXPECT_TRUE(HasHalves(whole));
    EXPECT_THROW(AddPicture(view, &whole), std::invalid_argument);
}

TEST(PictureRecords, StayWithoutHalvesInFiles) {
    ViewpointRecording viewpoint;
    viewpoint.name = "room";
    viewpoint.blockCount = 1;
    viewpoint.cap = 128;
    viewpoint.blocks[0] = Record({64, 128});
    const std::vector<std::byte> bytes = EncodeDataset(std::span(&viewpoint, 1));
    const ScratchFile file(".h5",
                           std::string(reinterpret_cast<const char*>(bytes.data()), bytes.size()));
    const ViewpointRecording read = ReadDataset(file.path).at(0);
    EXPECT_EQ(read.passSpp, 0);
    EXPECT_EQ(read.blocks.at(0).absent, viewpoint.blocks[0].absent);
}

TEST(PictureRecords, AreLookedAtWhereverTheyCome) {
    std::vector<int> spp;
    for (double n = 30; n < 9000; n *= 1.3) spp.push_back(int(n));
    const BlockRecording recording = Record(spp, 0.1);
    const LabelledBlock block = Labelled(recording);
    const RuleContext context{.passSpp = 0};
    const RuleOutcome outcome = SimulateRule(block, ParseRule("entropy:0.5", context));
    EXPECT_EQ(outcome.verdicts.size(), spp.size());
    EXPECT_FALSE(outcome.open);
    EXPECT_NE(std::ranges::find(spp, outcome.stop), spp.end());
    // As if the pictures were shown to a criterion.
    const auto criterion = MakeCriterion(ParseRule("entropy:0.5", context));
    int shown = 0;
    for (const int n : spp) {
        shown = n;
        if (criterion->Observe(NoisyBlock(40, 40, 0.1, n, unsigned(n)).At(n)).stop) break;
    }
    EXPECT_EQ(outcome.stop, shown);
    // Rules that count stop at a picture.
    EXPECT_EQ(MakeSimulator("fixed:100", context)(block).stop, *std::ranges::lower_bound(spp, 100));
    EXPECT_EQ(MakeSimulator("fixed:9500", context)(block).stop, 9500);
}

TEST(PictureRecords, CannotBeComparedWithHalves) {
    const BlockRecording recording = Record({20, 40, 60});
    const LabelledBlock block = Labelled(recording);
    for (const char* rule : {"lnoise:0.5", "dammertz:0.01", "luxtile:0.1"})
        EXPECT_NE(
            WhatOf([&] { MakeSimulator(rule, {.passSpp = 0})(block); }).find("half of the samples"),
            std::string::npos)
            << rule;
    EXPECT_THROW(SimulateCycles(block, 0.01), std::invalid_argument);
    const std::vector<LabelledBlock> blocks = {block, Labelled(recording, "hall")};
    for (const Rival& rival : EvaluateRivals(blocks, ChooseBy::AbsoluteError, 40))
        EXPECT_TRUE(rival.rule.starts_with("entropy")) << rival.rule;
}

TEST(PictureRecords, SayWhereTheyLieTooFarApart) {
    const BlockRecording recording = Record({64, 128, 256, 512, 1024});
    const std::string model = std::string(LULL_SOURCE_DIR) + "/stopping/models/entropy.h5";
    const std::string said =
        WhatOf([&] { MakeSimulator("learned:" + model, {.passSpp = 0})(Labelled(recording)); });
    EXPECT_NE(said.find("pictures at 64, 128, 256, 512, ... spp lie too far apart"),
              std::string::npos)
        << said;
}

TEST(PictureRecords, GoOnAsFarApartAsTheLast) {
    const BlockRecording recording = Record({100, 150, 225});
    const BlockRecording extended = ExtendRecording(recording, 0, 400);
    EXPECT_EQ(extended.spp, (std::vector<int>{100, 150, 225, 300, 375}));
    EXPECT_EQ(extended.values.size(), 5u * kRecordLength);
}

TEST(PictureRecords, TrainModelsThatLookAtAnySpp) {
    std::vector<int> spp;
    for (double n = 30; n < 2000; n *= 1.3) spp.push_back(int(n));
    const BlockRecording recording = Record(spp);
    const LabelledBlock block = Labelled(recording);
    const ModelSettings geometric{.k = 2,
                                  .features = {Feature::VisibleDrop},
                                  .takesMean = true,
                                  .spacing = Spacing::Geometric,
                                  .ratio = 1.4142};
    EXPECT_GT(MakeSamples(std::span(&block, 1), geometric).Count(), 5u);
    EXPECT_THROW(MakeSamples(std::span(&block, 1), ModelSettings{}), std::invalid_argument);
}

TEST(TestBlocks, AreThoseThatAreNotListed) {
    const BlockRecording recording = Record({20, 40});
    std::vector<LabelledBlock> blocks(3, Labelled(recording));
    for (int i = 0; i < 3; ++i) blocks[size_t(i)].block = i;
    const std::vector<ThresholdsRow> rows = {{"room", {2, 0}}};
    const std::vector<LabelledBlock> test = TestBlocks(blocks, rows);
    ASSERT_EQ(test.size(), 1u);
    EXPECT_EQ(test[0].block, 1);
    EXPECT_THROW(TestBlocks(blocks, std::vector<ThresholdsRow>{{"room", {0, 1, 2}}}),
                 std::invalid_argument);
    EXPECT_THROW(TestBlocks(blocks, std::vector<ThresholdsRow>{{"hall", {0}}}),
                 std::invalid_argument);
}

}  // namespace
}  // namespace lull::picture_records_test
