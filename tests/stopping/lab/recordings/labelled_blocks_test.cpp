#include "stopping/lab/recordings/labelled_blocks.h"

#include <gtest/gtest.h>

#include "tests/stopping/lab/training/learning_data.h"

namespace lull {
namespace {

// Stores warnings.
struct Listener {
    std::vector<std::string> said;
    WarningSink Ear() {
        return [this](const std::string& message) { said.push_back(message); };
    }
};

TEST(LabelledBlocks, AreThoseThatPeopleJudged) {
    const LearningData data;
    Listener listener;
    const auto read = [&](const std::vector<std::string>& without) {
        listener.said.clear();
        return ReadLabelledBlocks(data.viewpoints, data.human.path, without, listener.Ear());
    };
    EXPECT_EQ(read({}).size(), 7u);
    EXPECT_EQ(listener.said,
              std::vector<std::string>{data.human.path + " has no thresholds for 'cellar'"});
    EXPECT_EQ(read({"barn"}).size(), 4u);
    EXPECT_EQ(read({"cellar"}).size(), 7u);
    EXPECT_TRUE(listener.said.empty());
    EXPECT_THROW(read({"attic", "barn"}), std::runtime_error);
    EXPECT_THROW(read({"shed"}), std::runtime_error);
}

TEST(LabelledBlocks, NameTheFileThatDoesNotFit) {
    const LearningData data;
    const ScratchFile shorter(".csv", "attic;40;40;\n");
    try {
        ReadLabelledBlocks(data.viewpoints, shorter.path, {}, [](const std::string&) {});
        FAIL();
    } catch (const std::runtime_error& error) {
        EXPECT_TRUE(std::string(error.what()).starts_with(shorter.path + ": ")) << error.what();
    }
}

TEST(LabelledBlocks, AreReadFromSeveralFilesAsOne) {
    const LearningData data, other;
    const std::vector<ViewpointRecording> all = ReadDatasets({data.dataset.path});
    EXPECT_EQ(all.size(), 3u);
    EXPECT_EQ(ReadDatasets({data.dataset.path, other.dataset.path}).size(), 3u);
    EXPECT_THROW(ReadDatasets({data.human.path}), std::runtime_error);
}

TEST(LabelledBlocks, HaveAllThatIsAskedFor) {
    LearningData data;
    data.viewpoints[0].blocks.at(2).absent.set(ChannelIndex("attributes26"));
    const std::vector<LabelledBlock> blocks = data.Blocks();
    const ModelSettings entropy, attributes{.features = ParseFeatures("attributes26")};
    Listener listener;
    EXPECT_EQ(KeepRecorded(blocks, entropy, listener.Ear()).size(), 7u);
    EXPECT_TRUE(listener.said.empty());
    EXPECT_EQ(KeepRecorded(blocks, attributes, listener.Ear()).size(), 6u);
    EXPECT_EQ(listener.said,
              std::vector<std::string>{"1 of 7 blocks were recorded without attributes26"});
    for (ViewpointRecording& viewpoint : data.viewpoints)
        for (auto& [number, block] : viewpoint.blocks)
            block.absent.set(ChannelIndex("attributes26"));
    EXPECT_THROW(KeepRecorded(blocks, attributes, listener.Ear()), std::runtime_error);
}

}  // namespace
}  // namespace lull
