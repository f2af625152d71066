#include "stopping/lab/recordings/recording.h"

#include <gtest/gtest.h>

#include <cmath>

#include "stopping/features/model_inputs.h"
#include "stopping/lab/recordings/dataset.h"
#include "stopping/rules/baselines.h"
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
        const auto expectFeature = [&](const char* channel, int m, Feature feature) {
            const std::vector<double> values =
                MeasureBlock(view, {.m = m, .features = {feature}}).Of(feature);
            const std::span<const float> recorded = recording.Values(i, channel);
            ASSERT_EQ(recorded.size(), size_t(m));
            for (int k = 0; k < m; ++k) EXPECT_EQ(recorded[k], float(values[k])) << channel;
        };
        expectFeature("h4", 4, Feature::H);
        expectFeature("h25", 25, Feature::H);
        expectFeature("h100", 100, Feature::H);
        expectFeature("h400", 400, Feature::H);
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

void WriteBytes(const std::string& path, std::span<const std::byte> bytes) {
    std::ofstream(path, std::ios::binary)
        .write(reinterpret_cast<const char*>(bytes.data()), std::streamsize(bytes.size()));
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
    EXPECT_EQ(EncodeDataset(read), EncodeDataset(read));
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

    const auto errorOf = [&](const ViewpointRecording& added) -> std::string {
        try {
            AddToDataset(added, &dataset);
        } catch (const std::runtime_error& e) {
            return e.what();
        }
        return "";
    };
    more = MakeViewpoint("a");
    more.provenance["seed"] = "7";
    EXPECT_NE(errorOf(more).find("another seed (0, now 7)"), std::string::npos) << errorOf(more);
    more = MakeViewpoint("a");
    more.cap = 200;
    EXPECT_NE(errorOf(more).find("another cap"), std::string::npos);
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

}  // namespace
}  // namespace lull::recording_test
