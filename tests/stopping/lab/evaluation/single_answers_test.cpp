#include "stopping/lab/evaluation/single_answers.h"

#include <gtest/gtest.h>

#include <sstream>
#include <stdexcept>

#include "tests/stopping/what_of.h"

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
        EXPECT_NE(
            ErrorOf(std::string("block,spp,noise_seen,observer,track\n") + line).find("a.csv:2: '"),
            std::string::npos)
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
    try {
        CheckBlocks(answers, 16, "a.csv");
        FAIL();
    } catch (const std::runtime_error& error) {
        EXPECT_TRUE(std::string(error.what()).starts_with("a.csv:3: block 16")) << error.what();
    }
}

}  // namespace
}  // namespace lull::single_answers_test
