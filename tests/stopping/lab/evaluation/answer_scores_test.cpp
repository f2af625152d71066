#include "stopping/lab/evaluation/answer_scores.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <sstream>
#include <stdexcept>

#include "tests/stopping/lab/recordings/made_up_recordings.h"
#include "tests/stopping/scratch_file.h"

namespace lull::single_answers_test {
namespace {

std::vector<SingleAnswer> Read(const std::string& text) {
    std::istringstream in(text);
    return ReadSingleAnswers(in, "a.csv");
}

std::string ErrorOf(const std::string& text) {
    return WhatOf([&] { Read(text); });
}

TEST(SingleAnswers, AreReadLineByLine) {
    const auto answers = Read("block,spp,noise_seen\r\n5,640,1\r\n\n0,10000,0");
    ASSERT_EQ(answers.size(), 2u);
    EXPECT_EQ(answers[0].block, 5);
    EXPECT_EQ(answers[0].spp, 640);
    EXPECT_TRUE(answers[0].seen);
    EXPECT_EQ(answers[0].line, 2);
    EXPECT_EQ(answers[1].spp, 10000);
    EXPECT_FALSE(answers[1].seen);
    EXPECT_EQ(answers[1].line, 4);
}

TEST(SingleAnswers, HaveObserversAndTracks) {
    const auto answers =
        Read("block,spp,noise_seen,observer,track\n5,640,1,\"a, b\",3\n0,20,0,ada,\n");
    ASSERT_EQ(answers.size(), 2u);
    EXPECT_EQ(answers[0].track, 3);
    EXPECT_EQ(answers[0].observer, "\"a, b\"");
    EXPECT_EQ(answers[1].track, 0);
    EXPECT_EQ(answers[1].observer, "ada");
    for (const char* line : {"5,640,1", "5,640,1,ada", "5,640,1,ada,x", "5,640,1,ada,0"})
        EXPECT_HAS(ErrorOf(std::string("block,spp,noise_seen,observer,track\n") + line),
                   "a.csv:2: '")
            << line;
}

TEST(SingleAnswers, SayWhereAndWhatIsWrong) {
    const std::string head = "block,spp,noise_seen\n";
    const struct {
        std::string text, error;
    } cases[] = {{"", "a.csv: has no answers"},
                 {head, "a.csv: has no answers"},
                 {"5,640,1\n", "a.csv:1: the first line has to be block,spp,noise_seen"},
                 {head + "5,640,1\n5,640\n", "a.csv:3: '5,640' is not an answer"},
                 {head + "5,640,1,2\n", "a.csv:2: '5,640,1,2' is not an answer"},
                 {head + "5, 640,1\n", "a.csv:2: "},
                 {head + "5,x,1\n", "a.csv:2: "},
                 {head + "5,99999999999,1\n", "a.csv:2: "},
                 {head + "-1,640,1\n", "a.csv:2: there can be no block -1"},
                 {head + "5,0,1\n", "a.csv:2: 0 samples per pixel"},
                 {head + "5,640,2\n", "a.csv:2: noise_seen is 2"}};
    for (const auto& [text, error] : cases)
        EXPECT_TRUE(ErrorOf(text).starts_with(error)) << text << ": " << ErrorOf(text);
    EXPECT_THROW(ReadSingleAnswers("/no/such/file.csv"), std::runtime_error);
}

TEST(SingleAnswers, AreToBlocksThatThereAre) {
    const auto answers = Read("block,spp,noise_seen\n15,20,1\n16,20,1\n");
    EXPECT_NO_THROW(CheckBlocks(answers, 17, "a.csv"));
    EXPECT_TRUE(
        WhatOf([&] { CheckBlocks(answers, 16, "a.csv"); }).starts_with("a.csv:3: block 16"));
}

}  // namespace
}  // namespace lull::single_answers_test

namespace lull::answer_scores_test {
namespace {

// Returns a picture of 9 blocks, 7 of them recorded, whose noise is 0.5 at the thresholds. The
// errors of `dammertz` go the other way.
ViewpointRecording Picture(std::span<const double> thresholds, int end) {
    ViewpointRecording viewpoint{.name = "attic",
                                 .blockCount = 9,
                                 .cap = end,
                                 .passSpp = 20,
                                 .provenance = {},
                                 .blocks = {},
                                 .blockNotes = {}};
    for (int i = 0; i < 7; ++i) {
        BlockRecording recording = EmptyRecording(end);
        SetChannel(&recording, "masked_noise",
                   [&](int spp) { return 0.5 * std::sqrt(thresholds[size_t(i)] / spp); });
        SetChannel(&recording, "dammertz",
                   [&](int spp) { return 0.01 * std::sqrt(1e6 / thresholds[size_t(i)] / spp); });
        viewpoint.blocks[i] = recording;
    }
    return viewpoint;
}

// Returns answers of people with these thresholds and a scatter in log spp.
std::vector<SingleAnswer> Answers(std::span<const double> thresholds, int each, double scatter) {
    std::mt19937 generator(11);
    std::normal_distribution<double> gauss;
    std::uniform_real_distribution<double> place(std::log(60), std::log(9000));
    std::vector<SingleAnswer> answers;
    for (size_t i = 0; i < thresholds.size(); ++i)
        for (int k = 0; k < each; ++k) {
            const double spp = std::exp(place(generator));
            answers.push_back({.block = int(i),
                               .spp = int(spp),
                               .seen = std::log(thresholds[i] / spp) > scatter * gauss(generator)});
        }
    return answers;
}

const std::vector<double> kThresholds = {200, 400, 800, 1600, 3200, 1000, 500, 600, 700};

TEST(AnswerScores, SharesOutWhatTheRulesExplain) {
    const ViewpointRecording picture = Picture(kThresholds, 10000);
    const std::vector<std::string> rules = {"lnoise:0.5", "dammertz:0.01", "fixed:800"};
    const AnswerScores scores =
        EvaluateByAnswers(picture, Answers(kThresholds, 200, 0.5), rules, {});
    EXPECT_EQ(scores.viewpoint, "attic");
    EXPECT_EQ(scores.used.all, 1800);
    EXPECT_EQ(scores.used.allBlocks, 9);
    EXPECT_EQ(scores.used.answers, 1400);
    EXPECT_EQ(scores.used.blocks, 7);
    EXPECT_EQ(scores.used.notRecorded, 400);
    EXPECT_EQ(scores.used.blocksNotRecorded, (std::vector<int>{7, 8}));
    EXPECT_LT(scores.worst, scores.best);
    ASSERT_EQ(scores.blocks.size(), 7u);
    for (size_t i = 0; i < 7; ++i) {
        EXPECT_EQ(scores.blocks[i].answers, 200);
        ASSERT_TRUE(scores.blocks[i].threshold);
        EXPECT_NEAR(std::log(*scores.blocks[i].threshold / kThresholds[i]), 0, 0.25);
    }
    ASSERT_EQ(scores.rules.size(), 3u);
    // The numbers of lnoise are those that people go by, and noise falls as the root of the spp.
    const RuleByAnswers& noise = scores.rules[0];
    EXPECT_NEAR(noise.explained.value(), 1, 0.03);
    EXPECT_NEAR(noise.slope, 2 / 0.5, 0.6);
    EXPECT_NEAR(noise.level.value(), 1, 0.15);
    EXPECT_GT(noise.auc, 0.9);
    // The order of blocks is the wrong one, and fixed has none.
    EXPECT_LT(scores.rules[1].explained.value(), 0);
    EXPECT_LT(scores.rules[1].auc, scores.rules[2].auc);
    const RuleByAnswers& fixed = scores.rules[2];
    EXPECT_NEAR(fixed.explained.value(), 0, 1e-6);
    EXPECT_NEAR(fixed.early.value(), 2 / 7.0, 0.15);
    EXPECT_NEAR(fixed.late.value(), 3 / 7.0, 0.15);
    EXPECT_EQ(fixed.stops, std::vector<int>(7, 800));
    EXPECT_EQ(fixed.open, 0);
}

// Each answer given ten times over in one adjustment is one answer.
TEST(AnswerScores, CountsTheAnswersOfATrackAsOne) {
    const ViewpointRecording picture = Picture(kThresholds, 10000);
    const std::vector<std::string> rules = {"lnoise:0.5"};
    std::vector<SingleAnswer> answers = Answers(kThresholds, 40, 0.5), tracks;
    for (size_t i = 0; i < answers.size(); ++i)
        for (int k = 0; k < 10; ++k) {
            tracks.push_back(answers[i]);
            tracks.back().track = int(i) + 1;
        }
    const AnswerScores one = EvaluateByAnswers(picture, answers, rules, {});
    const AnswerScores all = EvaluateByAnswers(picture, tracks, rules, {});
    EXPECT_EQ(one.used.tracks, 0);
    EXPECT_EQ(all.used.tracks, one.used.answers);
    EXPECT_EQ(all.used.answers, 10 * one.used.answers);
    EXPECT_NEAR(all.best, one.best, 1e-6);
    EXPECT_NEAR(all.rules[0].logLikelihood, one.rules[0].logLikelihood, 1e-6);
    EXPECT_NEAR(all.rules[0].slope, one.rules[0].slope, 1e-6);
}

TEST(AnswerScores, LeavesOutWhatIsNotKnown) {
    // The recordings end at 1,000 spp; luxtile has no number before 40.
    const ViewpointRecording picture = Picture(kThresholds, 1000);
    std::vector<SingleAnswer> answers = Answers(kThresholds, 50, 0.5);
    const size_t beyond = size_t(std::ranges::count_if(
        answers, [](const SingleAnswer& a) { return a.block < 7 && a.spp > 1020; }));
    answers.push_back({.block = 1, .spp = 20, .seen = true});
    const std::vector<std::string> rules = {"lnoise:0.5", "luxtile:0.1"};
    const AnswerScores scores = EvaluateByAnswers(picture, answers, rules, {});
    EXPECT_EQ(scores.used.withoutNumber, int(beyond) + 1);
    EXPECT_EQ(scores.used.answers + scores.used.withoutNumber + scores.used.notRecorded,
              scores.used.all);
    EXPECT_EQ(scores.rules[0].open, 3);  // 1,000 as well: three votes
    EXPECT_NEAR(scores.rules[0].stops[3], 1700, 100);

    const std::vector<SingleAnswer> elsewhere = {{.block = 8, .spp = 100, .seen = true}};
    EXPECT_THROW(EvaluateByAnswers(picture, elsewhere, rules, {}), std::runtime_error);
}

TEST(AnswerScores, HasNoThresholdWhereAllAnswersAreTheSame) {
    const ViewpointRecording picture = Picture(kThresholds, 10000);
    std::vector<SingleAnswer> answers;
    for (const int spp : {100, 200, 400, 800}) {
        answers.push_back({.block = 0, .spp = spp, .seen = false});
        answers.push_back({.block = 4, .spp = spp, .seen = true});
        answers.push_back({.block = 1, .spp = spp, .seen = spp < 300});
    }
    const std::vector<std::string> rules = {"lnoise:0.5"};
    const AnswerScores scores = EvaluateByAnswers(picture, answers, rules, {});
    ASSERT_EQ(scores.blocks.size(), 3u);
    EXPECT_FALSE(scores.blocks[0].threshold);
    EXPECT_TRUE(scores.blocks[1].threshold);
    EXPECT_FALSE(scores.blocks[2].threshold);
    EXPECT_GT(scores.best, -1e-3);
    // Answers that are all the same leave nothing to explain.
    std::erase_if(answers, [](const SingleAnswer& a) { return a.block != 4; });
    const AnswerScores same = EvaluateByAnswers(picture, answers, rules, {});
    EXPECT_FALSE(same.rules[0].explained);
    EXPECT_FALSE(same.rules[0].level);
    EXPECT_TRUE(std::isfinite(same.rules[0].logLikelihood));
}

}  // namespace
}  // namespace lull::answer_scores_test
