#include "renderer/files/outputs.h"

#include <gtest/gtest.h>

#include <vector>

#include "tests/renderer/files/test_files.h"

namespace lull {
namespace {

namespace fs = std::filesystem;

std::string Check(const std::vector<NamedFile>& outputs, const std::vector<NamedFile>& inputs) {
    return ErrorOf([&] { CheckOutputs(outputs, inputs); });
}

TEST(CheckOutputs, TakesFilesThatAreNotTheSame) {
    const TemporaryDirectory directory;
    const std::string input = directory.Write("in.h5", "");
    EXPECT_NO_THROW(CheckOutputs(
        std::vector<NamedFile>{{"-o", directory.File("out.exr")},
                               {"--report", directory.File("out.json")},
                               {"--csv", ""},
                               {"--ranges", ""}},
        std::vector<NamedFile>{{"the scene", input}, {"a file of it", input}, {"--human", ""}}));
}

TEST(CheckOutputs, NamesBothOfTheSame) {
    const TemporaryDirectory directory;
    const std::string file = directory.File("r.json");
    EXPECT_EQ(Check({{"--report", file}, {"--checkpoint", file}}, {}),
              "--checkpoint \"" + file + "\" would replace --report \"" + file +
                  "\"; give it another name");
    EXPECT_TRUE(Contains(Check({{"-o", file}}, {{"DATA", file}}),
                         "-o \"" + file + "\" would replace DATA"));
}

TEST(CheckOutputs, KnowsFilesByOtherNames) {
    const TemporaryDirectory directory;
    const std::string file = directory.Write("human.csv", "precious");
    fs::create_symlink("human.csv", directory.File("link.csv"));
    fs::create_hard_link(file, directory.File("hard.csv"));
    fs::create_directory(directory.File("folder"));
    for (const char* name : {"link.csv", "hard.csv", "folder/../human.csv", "./human.csv"})
        EXPECT_TRUE(
            Contains(Check({{"--csv", directory.File(name)}}, {{"--human", file}}), "--human"))
            << name;
}

TEST(CheckOutputs, TakesDevicesTwice) {
    EXPECT_NO_THROW(
        CheckOutputs(std::vector<NamedFile>{{"-o", "/dev/null"}, {"--csv", "/dev/null"}}, {}));
}

TEST(BeginningOfNames, IsTheNameOrInAFolderThatIsMade) {
    const TemporaryDirectory directory;
    EXPECT_EQ(BeginningOfNames("", "room"), "room");
    EXPECT_EQ(BeginningOfNames("a/b", "room"), "a/b");
    const std::string folder = directory.File("new/deep/");
    EXPECT_EQ(BeginningOfNames(folder, "room"), folder + "room");
    EXPECT_TRUE(fs::is_directory(folder));
    EXPECT_EQ(BeginningOfNames(folder, "room"), folder + "room");
    const std::string file = directory.Write("file", "");
    EXPECT_TRUE(Contains(ErrorOf([&] { BeginningOfNames(file + "/", "room"); }), "-o " + file));
}

}  // namespace
}  // namespace lull
