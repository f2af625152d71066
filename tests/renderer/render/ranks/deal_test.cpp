#include "renderer/render/ranks/rank.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace lull {
namespace {

double ShareOf(const std::vector<int>& deal, int rank) {
    return double(std::ranges::count(deal, rank)) / double(deal.size());
}

TEST(EvenDeal, NamesEachRankOnce) {
    EXPECT_EQ(EvenDeal(1), std::vector<int>{0});
    EXPECT_EQ(EvenDeal(3), (std::vector<int>{0, 1, 2}));
}

TEST(DealBySpeed, GivesByHowFastTheyAre) {
    for (const std::vector<double>& speeds :
         {std::vector<double>{1, 1}, {3, 1}, {1, 2, 5}, {700, 20, 300, 100, 90}, {4}}) {
        const std::vector<int> deal = DealBySpeed(speeds);
        double all = 0;
        for (const double speed : speeds) all += speed;
        for (size_t r = 0; r < speeds.size(); ++r)
            EXPECT_NEAR(ShareOf(deal, int(r)), speeds[r] / all, 1.0 / double(deal.size())) << r;
        EXPECT_LT(GainOfDealing(speeds, deal), 1.3);
    }
}

// So that a block of few tiles is shared as well as one of many.
TEST(DealBySpeed, SpreadsRanksEvenly) {
    const std::vector<int> deal = DealBySpeed({6, 3, 1});
    for (size_t first = 0; first < deal.size(); ++first) {
        std::vector<int> counts(3, 0);
        for (size_t k = 0; k < 10; ++k) ++counts[size_t(deal[(first + k) % deal.size()])];
        EXPECT_NEAR(counts[0], 6, 1.1) << first;
        EXPECT_NEAR(counts[1], 3, 1.1) << first;
        EXPECT_NEAR(counts[2], 1, 1.1) << first;
    }
}

TEST(DealBySpeed, LeavesNobodyOut) {
    const std::vector<int> deal = DealBySpeed({1e9, 1e-9, 1});
    for (int rank = 0; rank < 3; ++rank) EXPECT_GT(ShareOf(deal, rank), 0) << rank;
    EXPECT_GT(ShareOf(deal, 0), 0.9);
}

TEST(RankSpeeds, TellsWhatItKnows) {
    RankSpeeds speeds(2);
    EXPECT_TRUE(speeds.Speeds(1).empty());
    speeds.Add(0, 100, 2);
    EXPECT_TRUE(speeds.Speeds(1).empty());
    speeds.Add(1, 10, 0.5);
    speeds.Add(1, 30, 1.5);
    EXPECT_TRUE(speeds.Speeds(3).empty());
    EXPECT_EQ(speeds.Speeds(2), (std::vector<double>{50, 20}));
    speeds.Forget();
    EXPECT_TRUE(speeds.Speeds(0).empty());
}

TEST(GainOfDealing, ComparesWithThePaceOfTheSlowest) {
    EXPECT_DOUBLE_EQ(GainOfDealing({1, 1}, {0, 1}), 1);
    EXPECT_DOUBLE_EQ(GainOfDealing({3, 1}, {0, 1}), 2);
    EXPECT_DOUBLE_EQ(GainOfDealing({3, 1}, {0, 0, 1, 0}), 1);
}

}  // namespace
}  // namespace lull
