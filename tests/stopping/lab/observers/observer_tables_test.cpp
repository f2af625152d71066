#include "stopping/lab/observers/observer_tables.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "stopping/base/csv.h"
#include "stopping/lab/evaluation/single_answers.h"
#include "tests/stopping/lab/observers/example_answers.h"

namespace lull {
namespace {

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
    std::vector<ObserverAnswers> answers;
    for (const ExampleAnswers& example :
         {ExampleAnswers{.observer = "a, b", .session = "1"},
          ExampleAnswers{.observer = "c", .session = "2", .levels = {3, 2, 3, 4}},
          ExampleAnswers{.observer = "d", .session = "3", .failed = 3}}) {
        answers.push_back(ParseAnswers(example.Text()));
        answers.back().file = example.session;
    }
    Collected collected = CollectObservers(std::move(answers), {});
    collected.refused.push_back({"x.json", "is not JSON, or cut short"});
    const std::string details = DetailsCsv(collected);
    EXPECT_TRUE(details.starts_with(
        "viewpoint,block,observers,mean,lowest,highest,deviation,octaves,answers\n"
        "room,0,2,100,40,160,84.85,1.414,2\n"))
        << details;
    const std::string observers = ObserversCsv(collected);
    EXPECT_NE(observers.find("\n1,room,\"a, b\",yes,,4,0,0,,"), std::string::npos) << observers;
    EXPECT_NE(observers.find("\n3,room,d,no,failed 3 of 4 checks,"), std::string::npos);
    EXPECT_TRUE(observers.ends_with("\nx.json,,,no,\"is not JSON, or cut short\"" +
                                    std::string(14, ',') + "\n"));
    const auto columns = std::ranges::count(observers.substr(0, observers.find('\n')), ',');
    EXPECT_EQ(columns, 4 + 14);
    EXPECT_NE(observers.find(",2.2,,60,,,,,"), std::string::npos) << observers;
}

// `lull evaluate --answers` reads the written file; excluded observers have no answers in it.
TEST(SingleAnswersCsv, HasWhatWasSeenUpToWhereItEnded) {
    std::vector<ObserverAnswers> answers;
    for (const ExampleAnswers& example :
         {ExampleAnswers{.session = "1", .levels = {2, 4}, .starts = {0, 3}},
          ExampleAnswers{.observer = "b", .session = "2", .levels = {1, 1}, .starts = {1, 2}},
          ExampleAnswers{.observer = "c", .session = "3", .levels = {3, 3}, .failed = 3}})
        answers.push_back(ParseAnswers(example.Text()));
    const std::string csv = SingleAnswersCsv(CollectObservers(std::move(answers), {}), "room");
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
