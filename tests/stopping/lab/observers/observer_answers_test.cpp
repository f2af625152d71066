#include "stopping/lab/observers/observer_answers.h"

#include <gtest/gtest.h>

#include <stdexcept>

#include "tests/stopping/lab/observers/example_answers.h"

namespace lull {
namespace {

// Returns the text with the first `from` replaced.
std::string With(std::string text, const std::string& from, const std::string& to) {
    const size_t at = text.find(from);
    EXPECT_NE(at, std::string::npos) << from;
    return at == std::string::npos ? text : text.replace(at, from.size(), to);
}

std::string ProblemOf(const std::string& text) try {
    ParseAnswers(text);
    return "none";
} catch (const std::runtime_error& e) {
    return e.what();
}

void ExpectProblem(const std::string& text, const std::string& part) {
    EXPECT_NE(ProblemOf(text).find(part), std::string::npos) << ProblemOf(text);
}

TEST(ParseAnswers, ReadsWhatThePageSaves) {
    const ObserverAnswers answers =
        ParseAnswers(ExampleAnswers{.repeats = {3}, .failed = 1}.Text());
    EXPECT_EQ(answers.observer, "ada");
    EXPECT_EQ(answers.viewpoint, "room");
    EXPECT_EQ(answers.levels, (std::vector<int>{20, 40, 80, 160, 320}));
    EXPECT_EQ(answers.thresholds, (std::vector<double>{(40 + 160) / 2.0, 80, 160, 320}));
    ASSERT_EQ(answers.answers.size(), 9u);
    EXPECT_EQ(answers.answers[1].kind, AnswerKind::Repeat);
    EXPECT_EQ(answers.answers[1].spp, 160);
    EXPECT_TRUE(answers.answers[5].failed);
    EXPECT_FALSE(answers.answers[6].failed);
    EXPECT_EQ(answers.gamma, 2.2);
    EXPECT_EQ(answers.seconds, 12.5);
    EXPECT_FALSE(answers.isIdle);
    EXPECT_TRUE(ParseAnswers(ExampleAnswers{.clicks = 0}.Text()).isIdle);
}

TEST(ParseAnswers, NamesWhatIsDamagedOrForeign) {
    const std::string good = ExampleAnswers{.repeats = {1}}.Text();
    for (size_t size = 0; size < good.size(); size += 7)
        ExpectProblem(good.substr(0, size), "not JSON, or cut short");
    for (const char* foreign : {"{}", "[]", "1", "null", R"({"format":"other"})"})
        ExpectProblem(foreign, "not a file of answers");
    ExpectProblem(With(good, "\"version\":1", "\"version\":2"), "another version");
    ExpectProblem(With(good, "\"finished\":\"2026-01-01T01:00:00.000Z\"", "\"finished\":null"),
                  "had not finished");
    ExpectProblem(With(good, "\"ada\"", "\"\""), "'observer'");
    ExpectProblem(With(good, "\"ada\"", "\"a\\nb\""), "'observer'");
    ExpectProblem(With(good, "\"room\"", "\"a;b\""), "; or /");
    ExpectProblem(With(good, "adjust", "staircase"), "unknown procedure 'staircase'");
    ExpectProblem(With(good, "20,40,80", "20,40,40"), "do not increase");
    ExpectProblem(With(good, "20,40,80", "20,1e300,80"), "'levels'");
    ExpectProblem(With(good, "\"blocks\":4", "\"blocks\":5"), "4 thresholds for 5 blocks");
    ExpectProblem(With(good, "\"blocks\":4", "\"blocks\":1e9"), "'blocks'");
    ExpectProblem(With(good, "\"block\":3", "\"block\":4"), "'block' is 4");
    ExpectProblem(With(good, "\"block\":3", "\"block\":-1"), "'block' is -1");
    ExpectProblem(With(good, "\"level\":4", "\"level\":5"), "'level' is 5");
    ExpectProblem(With(good, "\"kind\":\"catch\"", "\"kind\":\"x\""), "unknown kind");
    ExpectProblem(With(good, "\"failed\":false", "\"failed\":0"), "'failed'");
}

TEST(ParseAnswers, NamesContradictions) {
    const std::string good = ExampleAnswers{}.Text();
    EXPECT_EQ(ProblemOf(good), "none");
    ExpectProblem(With(good, "\"level\":2", "\"level\":3"), "threshold of block 1 is not the mean");
    ExpectProblem(With(good, "\"block\":1", "\"block\":2"), "block 1 has no answer");
    ExpectProblem(With(good, "\"kind\":\"asked\"", "\"kind\":\"repeat\""), "block 0 has no answer");
    ExpectProblem(With(good, "\"answers\":[",
                       R"("answers":[{"block":0,"clicks":0,"kind":"asked","level":1},)"),
                  "block 0 is answered more than once");
}

TEST(ReadAnswers, RefusesWhatCannotBeRead) {
    EXPECT_THROW(ReadAnswers("no such file"), std::runtime_error);
    EXPECT_THROW(ReadAnswers("/"), std::runtime_error);
}

}  // namespace
}  // namespace lull
