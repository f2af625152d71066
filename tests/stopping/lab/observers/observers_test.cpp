#include "stopping/lab/observers/observers.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "stopping/base/input_file.h"
#include "stopping/lab/evaluation/answer_scores.h"
#include "stopping/lab/observers/observer_answers.h"
#include "tests/stopping/lab/observers/example_answers.h"
#include "tests/stopping/scratch_file.h"

namespace lull {
namespace {

// Returns the text with the first `from` replaced.
std::string With(std::string text, const std::string& from, const std::string& to) {
    const size_t at = text.find(from);
    EXPECT_NE(at, std::string::npos) << from;
    return at == std::string::npos ? text : text.replace(at, from.size(), to);
}

void ExpectProblem(const std::string& text, const std::string& part) {
    EXPECT_HAS(WhatOf([&] { ParseAnswers(text); }), part);
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
    EXPECT_NO_THROW(ParseAnswers(good));
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

// Collects examples, which are files "0", "1", ...
Collected Collect(const std::vector<ExampleAnswers>& examples, const CollectOptions& options = {}) {
    std::vector<ObserverAnswers> answers;
    for (const ExampleAnswers& example : examples) {
        answers.push_back(ParseAnswers(example.Text()));
        answers.back().file = std::to_string(answers.size() - 1);
    }
    return CollectObservers(std::move(answers), options);
}

void ExpectRefused(const Collected& collected, size_t i, const std::string& file,
                   const std::string& part) {
    ASSERT_GT(collected.refused.size(), i);
    EXPECT_EQ(collected.refused[i].file, file);
    EXPECT_HAS(collected.refused[i].reason, part);
}

TEST(CollectObservers, TakesMeans) {
    const Collected collected =
        Collect({{.observer = "a", .session = "1", .levels = {1, 2, 4, 4}},
                 {.observer = "b", .session = "2", .levels = {2, 2, 4, 3}}});
    ASSERT_EQ(collected.viewpoints.size(), 1u);
    const CollectedViewpoint& room = collected.viewpoints[0];
    EXPECT_EQ(room.name, "room");
    EXPECT_EQ(room.observers, 2);
    EXPECT_EQ(room.blocks[0].mean, 60);
    EXPECT_EQ(room.blocks[0].lowest, 40);
    EXPECT_EQ(room.blocks[0].highest, 80);
    EXPECT_NEAR(room.blocks[0].deviation.value(), 20 * std::sqrt(2.0), 1e-9);
    EXPECT_NEAR(room.blocks[0].octaves.value(), std::sqrt(0.5), 1e-9);
    EXPECT_EQ(collected.observers[0].shiftOctaves, 0);  // lower in one block, higher in another

    const std::vector<ThresholdsRow> rows = ThresholdsOf(collected);
    ASSERT_EQ(rows.size(), 1u);
    EXPECT_EQ(rows[0].spp, (std::vector<int>{60, 80, 320, 240}));
}

TEST(CollectObservers, KnowsLittleOfOne) {
    const Collected collected = Collect({{}});
    const BlockConsensus& block = collected.viewpoints.at(0).blocks[0];
    EXPECT_EQ(block.mean, 40);
    EXPECT_FALSE(block.deviation || block.octaves);
}

TEST(CollectObservers, MeasuresRepeats) {
    // Twice the spp the first time, half of it the second.
    const Collected collected = Collect({{.levels = {1, 2, 3}, .repeats = {2, 1}}});
    EXPECT_EQ(collected.observers[0].repeats, 2);
    EXPECT_NEAR(collected.observers[0].repeatOctaves.value(), std::sqrt(0.5), 1e-9);
    EXPECT_FALSE(Collect({{}}).observers[0].repeatOctaves);
}

TEST(CollectObservers, LeavesOutWhoDoesNotLook) {
    const Collected collected = Collect({{.observer = "a", .session = "1"},
                                         {.observer = "b", .session = "2", .failed = 2},
                                         {.observer = "c", .session = "3", .failed = 1},
                                         {.observer = "d", .session = "4", .clicks = 0}});
    EXPECT_EQ(collected.viewpoints.at(0).observers, 2);
    EXPECT_EQ(collected.observers[0].leftOut, "");
    EXPECT_EQ(collected.observers[1].leftOut, "failed 2 of 4 checks");
    EXPECT_EQ(collected.observers[2].leftOut, "");
    EXPECT_EQ(collected.observers[3].leftOut, "pointed at nothing");
    EXPECT_FALSE(collected.observers[1].shiftOctaves);
    EXPECT_TRUE(collected.refused.empty());
    EXPECT_TRUE(Collect({{.failed = 4}}).viewpoints.empty());
}

TEST(CollectObservers, DoubtsUnusualDisplays) {
    const auto doubtsOf = [](const std::string& display) {
        return Collect({{.display = display}}).observers.at(0).doubts;
    };
    EXPECT_EQ(doubtsOf(R"({"gamma":2.2,"tones":"all","zoom":1,"pixelsPerDegree":40})"), "");
    EXPECT_EQ(doubtsOf(R"({"tones":"not all","gamma":1.2})"),
              "could not tell all tones of the display apart; had a display of gamma 1.20");
    EXPECT_EQ(doubtsOf(R"({"zoom":0.8,"pixelsPerDegree":12})"),
              "saw the page at a zoom of 80 %; saw 12 pixels a degree");
    EXPECT_EQ(doubtsOf(R"({"window":[1,2,3],"shown":1e300,"tones":{}})"), "");
}

TEST(CollectObservers, RefusesAnswersToOtherStudies) {
    const Collected collected =
        Collect({{.observer = "a", .session = "1", .study = "other"},
                 {.observer = "b", .session = "2"},
                 {.observer = "c", .session = "3"},
                 {.observer = "a", .session = "4", .study = "hall", .viewpoint = "hall"}});
    ExpectRefused(collected, 0, "0", "another study of 'room'");
    ASSERT_EQ(collected.viewpoints.size(), 2u);
    EXPECT_EQ(collected.viewpoints[0].name, "hall");
    EXPECT_EQ(collected.viewpoints[1].observers, 2);

    const Collected one =
        Collect({{.session = "1"}, {.session = "2", .study = "hall", .viewpoint = "hall"}},
                {.study = "hall"});
    ExpectRefused(one, 0, "0", "answers another study");
    EXPECT_EQ(one.viewpoints.size(), 1u);

    const Collected changed = Collect(
        {{.observer = "a", .session = "1"}, {.observer = "b", .session = "2", .levels = {1, 2}}});
    ExpectRefused(changed, 0, "1", "in another way");
}

TEST(CollectObservers, RefusesCopiesAndContradictions) {
    const Collected copies = Collect({{}, {}});
    ExpectRefused(copies, 0, "1", "copy of 0");
    EXPECT_EQ(copies.viewpoints.at(0).observers, 1);

    const Collected contradicting =
        Collect({{}, {.levels = {1, 2, 3, 3}}, {.observer = "b", .session = "2"}});
    ExpectRefused(contradicting, 0, "0", "same session");
    ExpectRefused(contradicting, 1, "1", "same session");
    EXPECT_EQ(contradicting.viewpoints.at(0).observers, 1);

    const Collected again = Collect({{.session = "1", .started = "2026-02-01T00:00:00.000Z"},
                                     {.session = "2", .started = "2026-01-01T00:00:00.000Z"}});
    ExpectRefused(again, 0, "0", "has judged 'room' before");
    EXPECT_EQ(again.observers.at(0).answers.session, "2");
}

TEST(CollectFiles, NamesFilesThatCannotBeRead) {
    const Collected collected = CollectFiles({"no such file"}, {});
    ASSERT_EQ(collected.refused.size(), 1u);
    EXPECT_EQ(collected.refused[0].file, "no such file");
    EXPECT_TRUE(collected.viewpoints.empty());
}

TEST(CollectObservers, SaysOfWhomItDoubts) {
    const Collected collected = Collect({{.observer = "a", .session = "1", .failed = 1},
                                         {.observer = "b", .session = "2", .seconds = 3},
                                         {.observer = "c", .session = "3", .seconds = 7},
                                         {.observer = "d", .session = "4", .repeats = {4, 0}}});
    EXPECT_EQ(collected.observers[0].doubts, "failed 1 of 4 checks");
    EXPECT_EQ(collected.observers[1].leftOut,
              "took 0.12 s per answer, too short to compare images");
    EXPECT_EQ(collected.observers[1].doubts, "");
    EXPECT_EQ(collected.observers[2].doubts, "took only 0.29 s an answer");
    EXPECT_EQ(collected.observers[3].doubts,
              "asked twice, gave answers that differ by a factor of 5.9");
    EXPECT_EQ(collected.viewpoints.at(0).observers, 3);
    EXPECT_EQ(collected.viewpoints[0].blocks[0].answers, 4);
    EXPECT_EQ(FewestAnswers(collected.viewpoints[0]), 3);
    EXPECT_EQ(Collect({{}}).observers[0].doubts, "");
}

TEST(CsvField, QuotesWhatWouldBreakTheLine) {
    EXPECT_EQ(CsvField("a b;c"), "a b;c");
    EXPECT_EQ(CsvField("a,b"), "\"a,b\"");
    EXPECT_EQ(CsvField("say \"a\""), "\"say \"\"a\"\"\"");
    EXPECT_EQ(CsvField("a\nb"), "\"a\nb\"");
    EXPECT_EQ(CsvField("a\rb"), "\"a\rb\"");
    EXPECT_EQ(CsvField(""), "");
}

TEST(CsvField, LeavesNoFormula) {
    EXPECT_EQ(CsvField("=cmd|' /C calc'!A0"), "'=cmd|' /C calc'!A0");
    EXPECT_EQ(CsvField("@SUM(1,2)"), "\"'@SUM(1,2)\"");
    EXPECT_EQ(CsvField("+1+A1"), "'+1+A1");
    EXPECT_EQ(CsvField("-"), "'-");
    EXPECT_EQ(CsvField("-1.5"), "-1.5");
    EXPECT_EQ(CsvField("a=b"), "a=b");
}

TEST(ObserverTables, HaveARowForEachBlockAndEachFile) {
    Collected collected = Collect({{.observer = "a, b", .session = "1"},
                                   {.observer = "c", .session = "2", .levels = {3, 2, 3, 4}},
                                   {.observer = "d", .session = "3", .failed = 3}});
    collected.refused.push_back({"x.json", "is not JSON, or cut short"});
    const std::string details = DetailsCsv(collected);
    EXPECT_TRUE(details.starts_with(
        "viewpoint,block,observers,mean,lowest,highest,deviation,octaves,answers\n"
        "room,0,2,100,40,160,84.85,1.414,2\n"))
        << details;
    const std::string observers = ObserversCsv(collected);
    EXPECT_HAS(observers, "\n0,room,\"a, b\",yes,,4,0,0,,");
    EXPECT_HAS(observers, "\n2,room,d,no,failed 3 of 4 checks,");
    EXPECT_TRUE(observers.ends_with("\nx.json,,,no,\"is not JSON, or cut short\"" +
                                    std::string(14, ',') + "\n"));
    EXPECT_EQ(std::ranges::count(observers.substr(0, observers.find('\n')), ','), 4 + 14);
    EXPECT_HAS(observers, ",2.2,,60,,,,,");
}

// `lull evaluate --answers` reads the written file; excluded observers have no answers in it.
TEST(SingleAnswersCsv, HasWhatWasSeenUpToWhereItEnded) {
    const Collected collected =
        Collect({{.session = "1", .levels = {2, 4}, .starts = {0, 3}},
                 {.observer = "b", .session = "2", .levels = {1, 1}, .starts = {1, 2}},
                 {.observer = "c", .session = "3", .levels = {3, 3}, .failed = 3}});
    const std::string csv = SingleAnswersCsv(collected, "room");
    EXPECT_EQ(csv,
              "block,spp,noise_seen,observer,track\n"
              "0,20,1,ada,1\n0,40,1,ada,1\n0,80,0,ada,1\n1,160,1,ada,2\n"
              "0,40,0,b,3\n1,40,0,b,4\n");
    std::istringstream in(csv);
    const std::vector<SingleAnswer> answersRead = ReadSingleAnswers(in, "answers.csv");
    ASSERT_EQ(answersRead.size(), 6u);
    EXPECT_EQ(answersRead[3].track, 2);
    EXPECT_EQ(answersRead[4].observer, "b");
    EXPECT_EQ(SingleAnswersCsv({}, "room"), "");
}

}  // namespace
}  // namespace lull
