#include "stopping/lab/training/search.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <set>
#include <sstream>

#include "tests/stopping/lab/recordings/made_up_recordings.h"
#include "tests/stopping/what_of.h"

namespace lull::search_test {
namespace {

std::vector<SearchAxis> Read(const std::string& text) {
    std::istringstream in(text);
    return ReadGrid(in, "grid.txt");
}

std::string ErrorOf(const std::string& text) {
    return WhatOf([&] { Read(text); });
}

TEST(SearchGrid, HasAllCombinations) {
    const std::vector<SearchAxis> axes =
        Read("# what is tried\n\nk 4 8 16\nfeatures\tH  H1,H2 # two\r\n  snorm 0 1");
    ASSERT_EQ(axes.size(), 3u);
    EXPECT_EQ(axes[0].line, 3);
    EXPECT_EQ(axes[1].values, (std::vector<std::string>{"H", "H1,H2"}));
    EXPECT_EQ(axes[2].option, "snorm");
    ASSERT_EQ(CombinationCount(axes), 12u);
    EXPECT_EQ(CombinationAt(axes, 0), (std::vector<std::string>{"4", "H", "0"}));
    EXPECT_EQ(CombinationAt(axes, 1), (std::vector<std::string>{"4", "H", "1"}));
    EXPECT_EQ(CombinationAt(axes, 11), (std::vector<std::string>{"16", "H1,H2", "1"}));
    std::set<std::vector<std::string>> all;
    for (size_t i = 0; i < 12; ++i) all.insert(CombinationAt(axes, i));
    EXPECT_EQ(all.size(), 12u);
}

TEST(SearchGrid, RefusesWhatIsNone) {
    EXPECT_EQ(ErrorOf("k 4\nn\n"), "grid.txt:2: 'n' has no values");
    EXPECT_EQ(ErrorOf("k 4\n#\nk 8\n"), "grid.txt:3: 'k' comes twice");
    EXPECT_EQ(ErrorOf("k 4 8 4\n"), "grid.txt:1: the value '4' comes twice");
    EXPECT_NE(ErrorOf(""), "");
    EXPECT_NE(ErrorOf("# k 4\n"), "");
    std::string many;
    for (const char* option : {"a", "b", "c"}) {
        many += option;
        for (int i = 0; i < 100; ++i) many.append(" ").append(std::to_string(i));
        many += "\n";
    }
    EXPECT_EQ(ErrorOf(many), "grid.txt:3: these are more than 100000 combinations");
    EXPECT_THROW(ReadGrid("/nowhere/grid.txt"), std::runtime_error);
}

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

std::vector<SearchResult> SomeResults() {
    return {{{"4", "H,noise"}, 0.7, 0.6, 0.9, 0.8, 0.2, 0.1, 0.3, 5},
            {{"8", "H,noise"}, kNone, kNone, kNone, kNone, kNone, kNone, kNone, 1},
            {{"16", "H"}, 0.75, 0.7, 0.95, 0.85, 0.15, 0.05, 0.25, 7},
            {{"32", "H"}, 0.7, 0.61, 0.91, 0.81, 0.21, 0.11, 0.31, 6}};
}

TEST(SearchResults, AreRankedByTheirAreaUnderTheCurve) {
    std::vector<SearchResult> results = SomeResults();
    RankResults(&results);
    EXPECT_EQ(results[0].values[0], "16");
    EXPECT_EQ(results[1].values[0], "4");
    EXPECT_EQ(results[2].values[0], "32");
    EXPECT_EQ(results[3].values[0], "8");

    const std::vector<SearchAxis> axes = Read("k 4 8 16 32\nfeatures H,noise H");
    const std::string csv = SearchCsv(axes, results);
    EXPECT_TRUE(
        csv.starts_with("k,features,auc_left_out,accuracy_left_out,auc_training,accuracy_training,"
                        "critical_error_2,early,late,seconds\n"
                        "16,H,0.750000,0.700000,0.950000,0.850000,0.150000,0.050000,0.250000,7.00\n"
                        "4,\"H,noise\",0.700000,0.600000,0.900000,"))
        << csv;
    const std::string table = SearchMarkdown(axes, results);
    EXPECT_NE(table.find("| 16 | H | 75.0 | 70.0 | 95.0 | 85.0 | 15.0 | 5 | 25 |\n"),
              std::string::npos)
        << table;
    EXPECT_NE(table.find("| 8 | H,noise | - | - | - | - | - | - | - |\n"), std::string::npos);
}

TEST(SearchResults, AreKept) {
    const std::vector<SearchResult> results = SomeResults();
    std::vector<std::byte> bytes = SaveResults("data", results);
    const std::vector<SearchResult> again = RestoreResults(bytes, "data");
    ASSERT_EQ(again.size(), 4u);
    EXPECT_EQ(again[0].values, results[0].values);
    EXPECT_EQ(again[0].late, 0.3);
    EXPECT_EQ(again[3].seconds, 6);
    EXPECT_TRUE(std::isnan(again[1].testAuc));
    EXPECT_THROW(RestoreResults(bytes, "other data"), std::runtime_error);
    for (size_t length = 0; length < bytes.size(); length += 7)
        EXPECT_THROW(RestoreResults(std::span(bytes).first(length), "data"), std::runtime_error);
    std::fill(bytes.begin() + 20, bytes.begin() + 30, std::byte(255));
    EXPECT_THROW(RestoreResults(bytes, "data"), std::runtime_error);
}

// The cost of a combination goes with what there is to do.
TEST(SearchCost, CountsSamplesAndWeights) {
    const std::vector<ViewpointRecording> viewpoints = {MakeViewpoint("a", 2, 4000),
                                                        MakeViewpoint("b", 2, 4000)};
    const std::vector<JudgedBlock> blocks =
        JoinHuman(viewpoints, std::vector{MakeHumanRow("a"), MakeHumanRow("b")}, nullptr);
    const std::vector<BlockSplit> splits = LeaveEachOut(blocks);
    const ModelSettings settings;
    const TrainingOptions training{.units = {32}, .epochs = 100};
    const double cost = SearchCost(settings, training, splits);
    TrainingOptions longer = training, larger = training;
    longer.epochs = 200;
    larger.units = {512, 128, 32};
    EXPECT_NEAR(SearchCost(settings, longer, splits) / cost, 2, 0.02);
    EXPECT_GT(SearchCost(settings, larger, splits) / cost, 50);
    EXPECT_NEAR(SearchCost({.n = 80}, training, splits) / cost, 0.5, 0.1);
    EXPECT_NEAR(SearchCost(settings, training, std::span(splits).first(1)) / cost, 0.5, 0.01);
    // No recording is long enough for any window.
    EXPECT_EQ(SearchCost({.k = 1000}, training, splits), 0);
}

TEST(SearchCost, SaysHowLongItTakes) {
    EXPECT_EQ(SecondsLeft(std::vector{1.0, 2.0}, {}), 0);
    EXPECT_NEAR(SecondsLeft(std::vector{1.0, 2.0, 5.0}, std::vector{3.0}), 21, 1e-12);
    EXPECT_NEAR(SecondsLeft(std::vector{1.0, 2.0, 5.0}, std::vector{3.0, 9.0}), 20, 1e-12);
    EXPECT_EQ(SecondsLeft(std::vector{1.0, 2.0}, std::vector{1.0, 1.0}), 0);
}

}  // namespace
}  // namespace lull::search_test
