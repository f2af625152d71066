#include "stopping/rules/votes.h"

#include <gtest/gtest.h>

#include <limits>
#include <vector>

namespace lull {
namespace {

std::vector<int> Select(const VoteSchedule& schedule, bool (VoteSchedule::*is)(int) const,
                        int end) {
    std::vector<int> result;
    for (int spp = 1; spp <= end; ++spp)
        if ((schedule.*is)(spp)) result.push_back(spp);
    return result;
}

TEST(VoteSchedule, RecordsWhatVotesLookBackTo) {
    const VoteSchedule eachPass = {.firstSpp = 20, .n = 40, .voteSpacing = 20};
    EXPECT_EQ(Select(eachPass, &VoteSchedule::Votes, 100), (std::vector<int>{20, 40, 60, 80, 100}));
    EXPECT_EQ(Select(eachPass, &VoteSchedule::Records, 100),
              (std::vector<int>{20, 40, 60, 80, 100}));

    const VoteSchedule onGrid = {.firstSpp = 20, .n = 40, .voteSpacing = 40};
    EXPECT_EQ(Select(onGrid, &VoteSchedule::Votes, 150), (std::vector<int>{20, 60, 100, 140}));
    EXPECT_EQ(Select(onGrid, &VoteSchedule::Records, 150), (std::vector<int>{20, 60, 100, 140}));

    const VoteSchedule rare = {.firstSpp = 20, .n = 40, .voteSpacing = 80};
    EXPECT_EQ(Select(rare, &VoteSchedule::Votes, 200), (std::vector<int>{20, 100, 180}));
    EXPECT_EQ(Select(rare, &VoteSchedule::Records, 110), (std::vector<int>{20, 60, 100}));

    const VoteSchedule coprime = {.firstSpp = 20, .n = 60, .voteSpacing = 40};
    for (int spp : Select(coprime, &VoteSchedule::Votes, 1000))
        for (int at = spp; at >= 20; at -= 60) EXPECT_TRUE(coprime.Records(at)) << at;
}

TEST(VoteCounter, NeedsVotesInARow) {
    VoteCounter votes{.needed = 3};
    for (double p : {0.1, 0.4999, 0.5}) {
        EXPECT_FALSE(votes.Stops());
        votes.Cast(p, 0.5);
    }
    EXPECT_EQ(votes.inRow, 0);  // 0.5 is noisy
    for (double p : {0.0, 0.2}) votes.Cast(p, 0.5);
    EXPECT_FALSE(votes.Stops());
    votes.Cast(0.3, 0.5);
    EXPECT_TRUE(votes.Stops());
    votes.Cast(std::numeric_limits<double>::quiet_NaN(), 0.5);
    EXPECT_EQ(votes.inRow, 0);
}

}  // namespace
}  // namespace lull
