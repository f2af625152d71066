// Runs the hard cases one by one. LULL_LONG=1 in the environment gives each of them the counts of
// a nightly run, LULL_SEED another seed.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdlib>

#include "tests/hard_cases/hard_case.h"

namespace lull {

// Tells the test framework how to name a case in its messages.
void PrintTo(const HardCase& hardCase, std::ostream* out) { *out << hardCase.name; }

namespace {

HardCaseOptions OptionsFromEnvironment() {
    HardCaseOptions options;
    options.isLong = std::getenv("LULL_LONG") != nullptr;
    if (const char* seed = std::getenv("LULL_SEED"))
        options.seed = std::strtoull(seed, nullptr, 10);
    return options;
}

class HardCases : public testing::TestWithParam<HardCase> {};

TEST_P(HardCases, HaveTheKnownAnswer) {
    const HardCaseOptions options = OptionsFromEnvironment();
    const HardCaseResult result = GetParam().run(options);
    const std::string row = fmt::format("{}: answer {}, ours {}, tolerance {}; {}", GetParam().name,
                                        NumberText(result.answer), NumberText(result.ours),
                                        NumberText(result.tolerance), result.note);
    fmt::print("{}\n", row);
    EXPECT_TRUE(result.Passed()) << row << " (seed " << options.seed << ")";
}

// Makes a name of letters and digits out of a case's.
std::string TestName(const testing::TestParamInfo<HardCase>& info) {
    std::string name = info.param.theme + " " + info.param.name;
    std::ranges::replace_if(
        name, [](unsigned char c) { return !std::isalnum(c); }, '_');
    return name;
}

INSTANTIATE_TEST_SUITE_P(, HardCases, testing::ValuesIn(AllHardCases()), TestName);

TEST(Worst, TakesNanForTheWorst) {
    const HardCaseResult good{1, 1, 0}, near{1, 1.1, 0.2}, bad{0, 1, 0}, nan{0, std::nan(""), 9};
    EXPECT_TRUE(good.Passed() && near.Passed());
    EXPECT_FALSE(bad.Passed() || nan.Passed());
    EXPECT_EQ(Worst(std::vector{good, near, good}).ours, 1.1);
    EXPECT_EQ(Worst(std::vector{bad, near, good}).ours, 1);
    EXPECT_TRUE(std::isnan(Worst(std::vector{near, nan, good}).ours));
}

TEST(Failures, KeepTheFirst) {
    Failures failures;
    EXPECT_TRUE(failures.Result("rays").Passed());
    for (int i = 0; i < 10; ++i) failures.Note(i > 6, [&] { return fmt::format("seed {}", i); });
    EXPECT_FALSE(failures.Result("rays").Passed());
    EXPECT_EQ(failures.Result("rays").ours, 3);
    EXPECT_EQ(failures.Result("rays").note, "of 10 rays, first: seed 7");
}

}  // namespace
}  // namespace lull
