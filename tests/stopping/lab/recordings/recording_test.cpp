#include "stopping/lab/recordings/recording.h"

#include <gtest/gtest.h>

#include <stdexcept>

#include "stopping/features/model_inputs.h"
#include "stopping/lab/evaluation/evaluated_rules.h"
#include "stopping/lab/evaluation/simulation.h"
#include "stopping/lab/recordings/extension.h"
#include "stopping/lab/recordings/labelled_blocks.h"
#include "stopping/rules/baselines.h"
#include "stopping/rules/rule_table.h"
#include "stopping/signals/lightness.h"
#include "stopping/signals/lightness_noise.h"
#include "tests/stopping/scratch_file.h"
#include "tests/stopping/signals/block_images.h"

namespace lull::recording_test {
namespace {

TEST(BlockRecorder, RecordsAllPassesFirstAndThenEverySecond) {
    for (int spp = 20; spp <= 400; spp += 20) EXPECT_TRUE(IsRecorded(spp, 20, 10000));
    EXPECT_TRUE(IsRecorded(420, 20, 10000));
    EXPECT_FALSE(IsRecorded(440, 20, 10000));
    EXPECT_TRUE(IsRecorded(9980, 20, 10000));
    EXPECT_TRUE(IsRecorded(10000, 20, 10000));
    EXPECT_FALSE(IsRecorded(9960, 20, 10000));
}

BlockRecording RecordNoise(int passes, int limit, double noise = 0.5) {
    BlockRecording recording;
    BlockRecorder recorder(20, 100000, limit, &recording);
    for (int pass = 1; pass <= passes; ++pass)
        if (recorder.Observe(NoisyBlock(80, 60, noise, 20 * pass, unsigned(pass)).At(20 * pass))
                .stop)
            break;
    return recording;
}

TEST(BlockRecorder, RecordsWhatTheRulesCompute) {
    const BlockRecording recording = RecordNoise(4, 1000);
    ASSERT_EQ(recording.spp, (std::vector<int>{20, 40, 60, 80}));
    ASSERT_EQ(recording.values.size(), size_t(4 * kRecordLength));
    for (int i = 0; i < 4; ++i) {
        const BlockImage image = NoisyBlock(80, 60, 0.5, 20 * (i + 1), unsigned(i + 1));
        const BlockView view = image.At(20 * (i + 1));
        EXPECT_EQ(recording.Values(i, "dammertz")[0], float(DammertzError(view)));
        EXPECT_EQ(recording.Values(i, "luxtile")[0], float(LuxTileError(view)));
        const auto expectFeature = [&](const std::string& channel, int m, Feature feature) {
            const std::vector<double> values =
                MeasureBlock(view, {.m = m, .features = {feature}}).Of(feature);
            const std::span<const float> recorded = recording.Values(i, channel);
            ASSERT_EQ(recorded.size(), size_t(m));
            for (int k = 0; k < m; ++k) EXPECT_EQ(recorded[k], float(values[k])) << channel;
        };
        for (const int m : {4, 25, 100, 400}) expectFeature("h" + std::to_string(m), m, Feature::H);
        expectFeature("h1", 100, Feature::H1);
        expectFeature("h2", 100, Feature::H2);
        const LightnessNoiseStatistics s =
            SubBlockStatistics(ComputeLightnessNoise(view), 80, 60, 100);
        EXPECT_TRUE(std::ranges::equal(recording.Values(i, "masked_noise"), s.maskedNoise));
        EXPECT_TRUE(std::ranges::equal(recording.Values(i, "noise"), s.noise));
        EXPECT_TRUE(std::ranges::equal(recording.Values(i, "half_noise"), s.halfNoise));
        EXPECT_TRUE(std::ranges::equal(recording.Values(i, "peak_noise"), s.peak));
        EXPECT_TRUE(std::ranges::equal(recording.Values(i, "texture"), s.texture));
        EXPECT_TRUE(std::ranges::equal(recording.Values(i, "deviation"), s.deviation));
        EXPECT_TRUE(std::ranges::equal(recording.Values(i, "lightness"), s.lightness));
        std::vector<uint8_t> srgb(view.mean.size());
        EncodeSrgb8(view.mean, srgb);
        std::vector<double> lightness(srgb.size() / 3);
        Lightness(srgb, lightness);
        const std::span<const float> attributes = recording.Values(i, "attributes26");
        const auto expected = ComputeAttributes(lightness, 80, 60);
        ASSERT_EQ(attributes.size(), expected.size());
        for (size_t k = 0; k < expected.size(); ++k) EXPECT_EQ(attributes[k], float(expected[k]));
    }
    EXPECT_THROW(ChannelOffset("no such"), std::invalid_argument);
}

TEST(BlockRecorder, EndsAtItsLimit) {
    EXPECT_EQ(RecordNoise(100, 50).spp.back(), 60);
    // Between the passes that are recorded, too: the last is always there.
    EXPECT_EQ(RecordNoise(100, 440).spp.back(), 440);
}

TEST(BlockRecorder, NotesWhereCyclesStops) {
    const BlockRecording recording = RecordNoise(60, 1200, 0.2);
    for (size_t i = 0; i < kCyclesThresholds.size(); ++i) {
        const auto criterion = MakeCriterion(CyclesRule(kCyclesThresholds[i]));
        int stop = 0;
        for (int pass = 1; pass <= 60 && stop == 0; ++pass)
            if (criterion->Observe(NoisyBlock(80, 60, 0.2, 20 * pass, unsigned(pass)).At(20 * pass))
                    .stop)
                stop = 20 * pass;
        EXPECT_EQ(recording.cyclesStops[i], stop) << kCyclesThresholds[i];
    }
    EXPECT_GT(recording.cyclesStops[0], 0);
    EXPECT_EQ(recording.cyclesStops.back(), 0);
}

TEST(BlockRecorder, GoesOnAfterARestart) {
    BlockRecording whole, before, after;
    BlockRecorder a(20, 1000, 1000, &whole), b(20, 1000, 1000, &before), c(20, 1000, 1000, &after);
    for (int pass = 1; pass <= 30; ++pass) {
        const BlockImage image = NoisyBlock(60, 60, 0.1, 20 * pass, unsigned(pass));
        a.Observe(image.At(20 * pass));
        if (pass <= 17) b.Observe(image.At(20 * pass));
        if (pass == 17) c.Restore(b.Save());
        if (pass > 17) c.Observe(image.At(20 * pass));
    }
    EXPECT_EQ(after.spp, whole.spp);
    EXPECT_EQ(after.values, whole.values);
    EXPECT_EQ(after.cyclesStops, whole.cyclesStops);

    std::vector<std::byte> state = a.Save();
    state.pop_back();
    EXPECT_THROW(c.Restore(state), std::runtime_error);
    state.resize(8);
    EXPECT_THROW(c.Restore(state), std::runtime_error);
}

ViewpointRecording MakeViewpoint(const std::string& name) {
    ViewpointRecording viewpoint{name, 16, 10000, 20, {{"seed", "0"}, {"scene", "x = y"}}, {}, {}};
    viewpoint.blocks[3] = RecordNoise(3, 1000);
    viewpoint.blocks[12] = RecordNoise(25, 1000, 0.2);
    viewpoint.blockNotes[3] = "12 s";
    return viewpoint;
}

TEST(Dataset, KeepsWhatWasRecorded) {
    const std::vector<ViewpointRecording> written = {MakeViewpoint("a"), MakeViewpoint("b")};
    const ScratchFile file(".h5");
    WriteBytes(file.path, EncodeDataset(written));
    const std::vector<ViewpointRecording> read = ReadDataset(file.path);
    ASSERT_EQ(read.size(), 2u);
    for (size_t v = 0; v < 2; ++v) {
        EXPECT_EQ(read[v].name, written[v].name);
        EXPECT_EQ(read[v].blockCount, 16);
        EXPECT_EQ(read[v].cap, 10000);
        EXPECT_EQ(read[v].passSpp, 20);
        EXPECT_EQ(read[v].provenance, written[v].provenance);
        EXPECT_EQ(read[v].blockNotes.at(3), "12 s");
        ASSERT_EQ(read[v].blocks.size(), 2u);
        for (const auto& [number, block] : written[v].blocks) {
            const BlockRecording& other = read[v].blocks.at(number);
            EXPECT_EQ(other.spp, block.spp);
            EXPECT_EQ(other.cyclesStops, block.cyclesStops);
            for (int i = 0; i < block.Count(); ++i) {
                for (size_t k = 0; k < 100; ++k) {
                    const float h = block.Values(i, "h100")[k];
                    EXPECT_NEAR(other.Values(i, "h100")[k], h, h * 0x1p-19);
                    const float noise = block.Values(i, "noise")[k];
                    EXPECT_NEAR(other.Values(i, "noise")[k], noise, noise * 0x1p-12);
                }
                EXPECT_NEAR(other.Values(i, "luxtile")[0], block.Values(i, "luxtile")[0], 1e-3);
            }
        }
    }
    // A data set that was read is written to the same bytes.
    EXPECT_EQ(EncodeDataset(read), EncodeDataset(written));
}

// Files from before there were attributes, to which newer blocks are added.
TEST(Dataset, HasBlocksWithoutAttributesBesideOthers) {
    ViewpointRecording older = MakeViewpoint("a");
    const size_t attributes = ChannelIndex("attributes26");
    for (auto& [number, block] : older.blocks) block.absent.set(attributes);
    const ScratchFile file(".h5");
    WriteBytes(file.path, EncodeDataset({&older, 1}));
    std::vector<ViewpointRecording> dataset = ReadDataset(file.path);
    ViewpointRecording more{"a", 16, 10000, 20, older.provenance, {}, {}};
    more.blocks[7] = RecordNoise(2, 1000);
    AddToDataset(more, &dataset);
    WriteBytes(file.path, EncodeDataset(dataset));

    dataset = ReadDataset(file.path);
    ASSERT_EQ(dataset[0].blocks.size(), 3u);
    for (const int number : {3, 12}) {
        const BlockRecording& block = dataset[0].blocks.at(number);
        EXPECT_EQ(block.absent.count(), 1u);
        EXPECT_TRUE(block.absent[attributes]);
        EXPECT_THROW(block.Values(0, "attributes26"), std::invalid_argument);
        EXPECT_GT(block.Values(0, "luxtile")[0], 0);
    }
    EXPECT_TRUE(dataset[0].blocks.at(7).absent.none());
    for (size_t k = 0; k < 26; ++k) {
        const float value = more.blocks.at(7).Values(1, "attributes26")[k];
        EXPECT_NEAR(dataset[0].blocks.at(7).Values(1, "attributes26")[k], value, value * 0x1p-19);
    }
}

TEST(Dataset, ReadsWhatTheProjectHas) {
    const ViewpointRecording read =
        ReadDataset(LULL_SCENES_DIR "/../stopping/data/coffee-splash-view0.h5").at(0);
    EXPECT_EQ(read.blocks.size(), 16u);
    for (const auto& [number, block] : read.blocks)
        EXPECT_GT(block.Values(block.Count() - 1, "h100")[0], 0) << number;
}

TEST(Dataset, AddsBlocksOfTheSameRecordingOnly) {
    std::vector<ViewpointRecording> dataset = {MakeViewpoint("a")};
    ViewpointRecording more{"a", 16, 10000, 20, dataset[0].provenance, {}, {}};
    more.blocks[7] = RecordNoise(2, 1000);
    AddToDataset(more, &dataset);
    ASSERT_EQ(dataset.size(), 1u);
    EXPECT_EQ(dataset[0].blocks.size(), 3u);
    more.name = "other";
    more.cap = 400;
    AddToDataset(more, &dataset);
    EXPECT_EQ(dataset.size(), 2u);

    const auto errorOf = [&](const ViewpointRecording& added) {
        return WhatOf([&] { AddToDataset(added, &dataset); });
    };
    more = MakeViewpoint("a");
    more.provenance["seed"] = "7";
    EXPECT_HAS(errorOf(more), "another seed (0, now 7)");
    more = MakeViewpoint("a");
    more.cap = 200;
    EXPECT_HAS(errorOf(more), "another cap");
}

TEST(Dataset, RefusesWhatIsNone) {
    EXPECT_THROW(ReadDataset("/nowhere/a.h5"), std::runtime_error);
    const ScratchFile text(".h5", "hello");
    EXPECT_THROW(ReadDataset(text.path), std::runtime_error);
    const ScratchFile file(".h5");
    const std::vector<std::byte> bytes = EncodeDataset(std::vector{MakeViewpoint("a")});
    for (const size_t length : {bytes.size() / 3, bytes.size() / 2, bytes.size() - 1}) {
        WriteBytes(file.path, std::span(bytes).first(length));
        EXPECT_THROW(ReadDataset(file.path), std::runtime_error) << length;
    }
}

BlockRecording Record(const std::vector<int>& spp, double noise = 0.5) {
    BlockRecording recording;
    for (const int n : spp) AddPicture(NoisyBlock(40, 40, noise, n, unsigned(n)).At(n), &recording);
    return recording;
}

LabelledBlock Labelled(const BlockRecording& recording, const char* viewpoint = "room") {
    return {.viewpoint = viewpoint, .human = 300, .passSpp = 0, .recording = &recording};
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
    const ScratchFile file(".h5");
    WriteBytes(file.path, EncodeDataset(std::span(&viewpoint, 1)));
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
        EXPECT_HAS(WhatOf([&] { MakeSimulator(rule, {.passSpp = 0})(block); }),
                   "half of the samples")
            << rule;
    EXPECT_THROW(SimulateCycles(block, 0.01), std::invalid_argument);
    const std::vector<LabelledBlock> blocks = {block, Labelled(recording, "hall")};
    for (const EvaluatedRule& rival : EvaluateRivals(blocks, ChooseBy::AbsoluteError, 40))
        EXPECT_TRUE(rival.name.starts_with("entropy")) << rival.name;
}

TEST(PictureRecords, SayWhereTheyLieTooFarApart) {
    const BlockRecording recording = Record({64, 128, 256, 512, 1024});
    const std::string model = std::string(LULL_SOURCE_DIR) + "/stopping/models/entropy.h5";
    const std::string said =
        WhatOf([&] { MakeSimulator("learned:" + model, {.passSpp = 0})(Labelled(recording)); });
    EXPECT_HAS(said, "pictures at 64, 128, 256, 512, ... spp lie too far apart");
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
}  // namespace lull::recording_test
