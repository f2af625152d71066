#include "stopping/rules/thresholds.h"

#include <gtest/gtest.h>

#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "tests/stopping/golden_data.h"
#include "tests/stopping/scratch_file.h"

namespace lull::thresholds_test {
namespace {

std::vector<ThresholdsRow> Parse(const std::string& text) {
    std::istringstream in(text);
    return ReadThresholds(in, "t.csv");
}

std::string ErrorOf(const std::string& text) {
    return WhatOf([&] { Parse(text); });
}

TEST(Thresholds, ReadThePublishedFilesAndWriteThemBack) {
    for (const auto& [name, count] : {std::pair("human", 40u), std::pair("svd-entropy-rnn", 80u),
                                      std::pair("26-attributes-rnn", 80u)}) {
        const std::string path = ThresholdsFile(std::string(name) + ".csv");
        const std::vector<ThresholdsRow> rows = ReadThresholds(path);
        EXPECT_EQ(rows.size(), count);
        for (const ThresholdsRow& row : rows) EXPECT_EQ(row.spp.size(), 16u) << row.name;

        std::ifstream file(path);
        std::stringstream original, written;
        original << file.rdbuf();
        WriteThresholds(written, rows);
        EXPECT_EQ(written.str(), original.str());
    }
}

TEST(Thresholds, AreForgivingAboutTheEnds) {
    const auto rows = Parse("a;20;40;\r\n\nb c;0;10000");
    ASSERT_EQ(rows.size(), 2u);
    EXPECT_EQ(rows[0].name, "a");
    EXPECT_EQ(rows[0].spp, (std::vector<int>{20, 40}));
    EXPECT_EQ(rows[1].name, "b c");
    EXPECT_EQ(rows[1].spp, (std::vector<int>{0, 10000}));
    EXPECT_TRUE(Parse("").empty());
}

TEST(Thresholds, NameTheLineThatIsWrong) {
    EXPECT_EQ(ErrorOf("a;20;\nb;20;x;\n"),
              "t.csv:2: 'x' is not a threshold; a whole number of samples is needed");
    for (const char* bad : {"-20", "20.5", " 20", "", "99999999999", "nan"})
        EXPECT_NE(ErrorOf("a;" + std::string(bad) + ";20;"), "") << bad;
    EXPECT_NE(ErrorOf("a;\n"), "");
    EXPECT_NE(ErrorOf(";20;\n"), "");
    EXPECT_NE(ErrorOf(";\n"), "");
    EXPECT_EQ(ErrorOf("a;20;\n\na;40;\n"), "t.csv:3: 'a' has a row already");
    for (const char* mark : {"\xfe\xff", "\xff\xfe", "\xef\xbb\xbf"})
        for (const char* name : {"b", "bc"})
            EXPECT_EQ(ErrorOf("a;20;\n" + std::string(mark) + name + ";40;\n"),
                      "t.csv:2: the name begins with a byte order mark; remove it");
    EXPECT_THROW(ReadThresholds("/no/such/file.csv"), std::runtime_error);
}

TEST(Thresholds, WriteOnlyWhatCanBeRead) {
    const ScratchFile file(".csv");
    WriteThresholds(file.path, {{"one", {1, 2, 3}}, {"two", {10000}}});
    const auto rows = ReadThresholds(file.path);
    ASSERT_EQ(rows.size(), 2u);
    EXPECT_EQ(rows[1].spp, std::vector<int>{10000});

    std::ostringstream out;
    EXPECT_THROW(WriteThresholds(out, {{"a;b", {1}}}), std::invalid_argument);
    EXPECT_THROW(WriteThresholds(out, {{"", {1}}}), std::invalid_argument);
    EXPECT_THROW(WriteThresholds(out, {{"a", {}}}), std::invalid_argument);
    EXPECT_THROW(WriteThresholds(out, {{"a", {-1}}}), std::invalid_argument);
    EXPECT_THROW(WriteThresholds("/no/such/folder/t.csv", {{"a", {1}}}), std::runtime_error);
}

}  // namespace
}  // namespace lull::thresholds_test

namespace lull {
namespace {

// Returns the leaders in an image cut into blocks of 200 pixels a side.
std::vector<int> Leaders(int width, int height) {
    return CutIntoBlocks(width, height, 200).leaders;
}

TEST(BlockGrid, HasWhatIsLeftAsSmallerBlocks) {
    const BlockGrid grid = CutIntoBlocks(439, 210, 200);
    EXPECT_EQ(grid.columns, 3);
    EXPECT_EQ(grid.blocks, (std::vector<BlockRect>{{0, 0, 200, 200},
                                                   {200, 0, 200, 200},
                                                   {400, 0, 39, 200},
                                                   {0, 200, 200, 10},
                                                   {200, 200, 200, 10},
                                                   {400, 200, 39, 10}}));
    EXPECT_EQ(CutIntoBlocks(500, 300, 65536).blocks, (std::vector<BlockRect>{{0, 0, 500, 300}}));
    EXPECT_TRUE(CutIntoBlocks(0, 300, 200).blocks.empty());
    EXPECT_TRUE(CutIntoBlocks(300, 0, 200).blocks.empty());
}

TEST(BlockGrid, HasNoFollowersWhereAnyBlockIsLargeEnough) {
    EXPECT_EQ(CutIntoBlocks(439, 200, 200, 0).leaders, (std::vector<int>{0, 1, 2}));
}

TEST(SmallBlocks, AreCheckedFrom40PixelsOn) {
    EXPECT_EQ(Leaders(800, 200), (std::vector<int>{0, 1, 2, 3}));
    EXPECT_EQ(Leaders(440, 240), (std::vector<int>{0, 1, 2, 3, 4, 5}));
}

TEST(SmallBlocks, FollowTheLargestNeighbour) {
    EXPECT_EQ(Leaders(439, 200), (std::vector<int>{0, 1, 1}));
    // Below the last, small row: the first of the largest three above; in the corner as well.
    EXPECT_EQ(Leaders(439, 439), (std::vector<int>{0, 1, 1, 3, 4, 1, 3, 3, 4}));
    // A neighbour that is large enough to vote, but not the largest.
    EXPECT_EQ(Leaders(230, 330), (std::vector<int>{0, 0, 2, 0}));
}

TEST(SmallBlocks, HaveNoLeaderInASmallImage) {
    EXPECT_EQ(Leaders(30, 30), (std::vector<int>{-1}));
    EXPECT_EQ(Leaders(1000, 39), (std::vector<int>{-1, -1, -1, -1, -1}));
}

}  // namespace
}  // namespace lull
