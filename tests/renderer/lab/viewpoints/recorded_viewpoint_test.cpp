#include "renderer/lab/viewpoints/recorded_viewpoint.h"

#include <gtest/gtest.h>

#include "renderer/lab/viewpoints/study.h"
#include "tests/renderer/files/test_files.h"
#include "tests/renderer/render/synthetic_samples.h"

namespace lull {
namespace {

const PixelRect kRoom{{3, 5}, {93, 49}};  // blocks of 45x44 pixels

RenderOptions RoomOptions() {
    RenderOptions options;
    options.schedule = {.blockSize = 45, .passLength = 4, .cap = 16};
    options.threads = 2;
    return options;
}

ViewpointRecording Frame() {
    return MakeViewpoint("room", RoomOptions().schedule, {{"scene", "a"}, {"cap", "16"}}, 2);
}

// Records up to limits, and returns what there is then of the viewpoint.
ViewpointRecording Record(const std::vector<int>& limits) {
    Film film(kRoom);
    ViewpointRecording viewpoint = Frame();
    EXPECT_FALSE(RecordBlocks(Onto(&film, RoomOptions()), limits, &viewpoint).cancelled);
    return viewpoint;
}

TEST(RecordingLimits, AreTheCapOfChosenBlocks) {
    EXPECT_EQ(RecordingLimits(3, {}, 100), (std::vector<int>{100, 100, 100}));
    EXPECT_EQ(RecordingLimits(3, {2, 0}, 100), (std::vector<int>{100, 0, 100}));
    EXPECT_EQ(ErrorOf([] { RecordingLimits(3, {3}, 100); }),
              "--blocks: there is no block 3, the last of the image is 2");
}

TEST(RecordingLimits, EndPastWhatPeopleSaid) {
    const TemporaryDirectory directory;
    const std::string human = directory.Write("human.csv", "room;30;61;0;\nhall;20;\n");
    std::vector<int> limits = {100, 80, 0};
    LimitByHuman(human, "room", 1.5, &limits);
    EXPECT_EQ(limits, (std::vector<int>{45, 80, 0}));
    EXPECT_HAS(ErrorOf([&] { LimitByHuman(human, "attic", 1, &limits); }), "has no row 'attic'");
    EXPECT_HAS(ErrorOf([&] { LimitByHuman(human, "hall", 1, &limits); }),
               "'hall' has 1 blocks, the image 3");
}

TEST(RecordedViewpoint, HasTheNamesThatFilesHaveRoomFor) {
    EXPECT_EQ(CheckViewpointName("room 1"), "");
    for (const char* bad : {"", "a/b", "a;b", "a\nb"}) EXPECT_NE(CheckViewpointName(bad), "");
    EXPECT_EQ(Frame().provenance, (std::map<std::string, std::string>{{"scene", "a"}}));
    EXPECT_THROW(CheckRecordable(MakeBlocks({{0, 0}, {39, 80}}, {}), {}), Error);
    CheckRecordable(MakeBlocks({{0, 0}, {40, 80}}, {}), {});
}

TEST(RecordBlocks, RecordsEachToThePassThatReachesItsLimit) {
    const ViewpointRecording whole = Record({16, 16}), part = Record({0, 6});
    EXPECT_EQ(whole.blocks.at(0).spp, (std::vector<int>{4, 8, 12, 16}));
    EXPECT_EQ(whole.blockNotes.size(), 2u);
    // What is recorded does not depend on the other blocks.
    ASSERT_EQ(part.blocks.size(), 1u);
    const BlockRecording& block = part.blocks.at(1);
    EXPECT_EQ(block.spp, (std::vector<int>{4, 8}));
    EXPECT_TRUE(
        std::ranges::equal(block.Values(1, "noise"), whole.blocks.at(1).Values(1, "noise")));
}

TEST(RecordBlocks, TellsOfProgressTowardsTheLimits) {
    Film film(kRoom);
    ViewpointRecording viewpoint = Frame();
    RenderOptions options = RoomOptions();
    RenderProgress last;
    options.events.onProgress = [&](const RenderProgress& progress) { last = progress; };
    RecordBlocks(Onto(&film, options), {0, 6}, &viewpoint);
    EXPECT_EQ(last.samples, 8 * 45 * 44);
    EXPECT_EQ(last.samplesToCap, 0);
}

TEST(RenderStudy, KeepsThePicturesOfEachLevelAndRecordsTheSameSamples) {
    const std::vector<Block> blocks = MakeBlocks(kRoom, RoomOptions().schedule);
    Study study = BeginStudy("room", kRoom, {4, 8, 16}, blocks, {{"scene", "a"}});
    EXPECT_EQ(study.width, 90);
    EXPECT_EQ(study.blocks[1].pixels, (PixelRect{{45, 0}, {90, 44}}));
    Film film(kRoom);
    ViewpointRecording viewpoint = Frame();
    RenderStudy(Onto(&film, RoomOptions()), &study, &viewpoint);
    for (const StudyBlock& block : study.blocks) {
        ASSERT_EQ(block.pictures.size(), 3u);
        for (const DisplayPixels& picture : block.pictures) EXPECT_EQ(picture.size(), 45u * 44 * 3);
        EXPECT_NE(block.pictures[0], block.pictures[2]);
    }
    EXPECT_EQ(viewpoint.blocks.at(1).values, Record({16, 16}).blocks.at(1).values);

    Film again(kRoom);
    Study alone = BeginStudy("room", kRoom, {4, 8, 16}, blocks, {{"scene", "a"}});
    RenderStudy(Onto(&again, RoomOptions()), &alone, nullptr);
    EXPECT_EQ(StudyId(alone), StudyId(study));
}

}  // namespace
}  // namespace lull
