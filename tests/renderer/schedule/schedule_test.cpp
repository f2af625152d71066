#include "renderer/schedule/schedule.h"

#include <gtest/gtest.h>

#include <map>

namespace lull {
namespace {

// Carries out the tiles that are ready, at most `most`, and returns them; `stop` decides on blocks.
template <typename Stop>
std::vector<Tile> RunAll(Schedule& schedule, const Stop& stop, size_t most = 1 << 30) {
    std::vector<Tile> tiles;
    while (tiles.size() < most) {
        const auto tile = schedule.Next();
        if (!tile) break;
        tiles.push_back(*tile);
        if (schedule.Finish(*tile))
            schedule.Decide(tile->block, stop(tile->block, schedule.Blocks()[tile->block].spp));
    }
    return tiles;
}

bool Never(int, int) { return false; }

TEST(MakeBlocks, CoversTheRegionRowByRow) {
    const PixelRect region{{7, 3}, {457, 313}};
    const std::vector<Block> blocks = MakeBlocks(region, {});
    ASSERT_EQ(blocks.size(), 6u);
    EXPECT_EQ(blocks[0].pixels, (PixelRect{{7, 3}, {207, 203}}));
    EXPECT_EQ(blocks[1].pixels, (PixelRect{{207, 3}, {407, 203}}));
    EXPECT_EQ(blocks[2].pixels, (PixelRect{{407, 3}, {457, 203}}));
    EXPECT_EQ(blocks[5].pixels, (PixelRect{{407, 203}, {457, 313}}));
    int64_t area = 0;
    for (const Block& block : blocks) area += block.pixels.Area();
    EXPECT_EQ(area, region.Area());
}

TEST(MakeBlocks, LetsSmallBlocksFollowTheirLargestNeighbour) {
    const std::vector<Block> blocks = MakeBlocks({{0, 0}, {430, 210}}, {.smallestSide = 40});
    ASSERT_EQ(blocks.size(), 6u);
    EXPECT_TRUE(blocks[0].votes);
    EXPECT_TRUE(blocks[1].votes);
    EXPECT_EQ(blocks[2].leader, 1);
    EXPECT_EQ(blocks[3].leader, 0);
    EXPECT_EQ(blocks[4].leader, 0);  // the first of two that are as large
    EXPECT_EQ(blocks[5].leader, 1);
    for (int i = 2; i < 6; ++i) EXPECT_FALSE(blocks[i].votes);
}

TEST(MakeBlocks, CutsBothEyesAlike) {
    const std::vector<Block> blocks =
        MakeBlocks({{0, 0}, {860, 210}}, {.smallestSide = 40, .eyeWidth = 430});
    ASSERT_EQ(blocks.size(), 12u);
    for (int i = 0; i < 6; ++i) {
        const Block &left = blocks[i], &right = blocks[i + 6];
        EXPECT_EQ(right.pixels.min - left.pixels.min, Vec2i(430, 0));
        EXPECT_EQ(right.pixels.max - left.pixels.max, Vec2i(430, 0));
        EXPECT_EQ(left.partner, i + 6);
        EXPECT_EQ(right.partner, i);
        EXPECT_EQ(right.leader, left.leader < 0 ? -1 : left.leader + 6);
    }
}

// Both blocks of a place end with the later vote, whatever the order; others do not wait.
TEST(Schedule, PairsStopTogether) {
    const std::vector<int> votesAt = {40, 100, 120, 60};  // two places, left eyes first
    for (const bool restarts : {false, true}) {
        const ScheduleOptions options{.blockSize = 16, .tileSize = 16, .eyeWidth = 32};
        Schedule schedule({{0, 0}, {64, 16}}, options);
        const auto stop = [&](int block, int spp) { return spp == votesAt[size_t(block)]; };
        if (restarts) {
            RunAll(schedule, stop, 13);
            std::vector<BlockStart> starts;
            for (const Block& block : schedule.Blocks())
                starts.push_back({.spp = block.spp,
                                  .stopped = block.stopped,
                                  .stoppedByVote = block.stoppedByVote,
                                  .hasVoted = block.spp >= votesAt[starts.size()]});
            schedule = Schedule({{0, 0}, {64, 16}}, options, starts);
        }
        RunAll(schedule, stop);
        EXPECT_TRUE(schedule.Done());
        const auto blocks = schedule.Blocks();
        EXPECT_EQ(blocks[0].spp, 120);
        EXPECT_EQ(blocks[2].spp, 120);
        EXPECT_EQ(blocks[1].spp, 100);
        EXPECT_EQ(blocks[3].spp, 100);
        for (const Block& block : blocks) EXPECT_TRUE(block.stoppedByVote);
    }
}

TEST(Schedule, GivesEachPixelOfAPassOnce) {
    Schedule schedule({{0, 0}, {50, 35}}, {.blockSize = 40, .tileSize = 16});
    std::map<std::pair<int, int>, int> seen;
    int tiles = 0;
    const int ready = schedule.ReadyTiles();
    while (const auto tile = schedule.Next()) {
        ++tiles;
        EXPECT_EQ(tile->first, 0);
        EXPECT_EQ(tile->count, 20);
        EXPECT_LE(tile->pixels.Width(), 16);
        for (int y = tile->pixels.min.y(); y < tile->pixels.max.y(); ++y)
            for (int x = tile->pixels.min.x(); x < tile->pixels.max.x(); ++x) ++seen[{x, y}];
    }
    EXPECT_EQ(tiles, ready);
    EXPECT_EQ(schedule.ReadyTiles(), 0);
    EXPECT_EQ(seen.size(), 50u * 35u);
    for (const auto& [pixel, count] : seen) EXPECT_EQ(count, 1);
}

// Also where the cap is below one pass.
TEST(Schedule, ShortensTheLastPassToTheCap) {
    for (const auto& [cap, passes, count] : {std::tuple(50, 3, 10), {7, 1, 7}}) {
        Schedule schedule({{0, 0}, {8, 8}}, {.passLength = 20, .cap = cap});
        const std::vector<Tile> tiles = RunAll(schedule, Never);
        ASSERT_EQ(tiles.size(), size_t(passes));
        EXPECT_EQ(tiles.back().first, cap - count);
        EXPECT_EQ(tiles.back().count, count);
        EXPECT_TRUE(schedule.Done());
        EXPECT_EQ(schedule.Blocks()[0].spp, cap);
        EXPECT_FALSE(schedule.Blocks()[0].stoppedByVote);
    }
}

// With a clock there may be no time for all of the first pass.
TEST(Schedule, TakesTheFirstPassInStepsByTheClock) {
    for (const auto& [pass, cap, ends] :
         {std::tuple(20, 50, std::vector<int>{1, 2, 4, 8, 20, 40, 50}),
          {20, 7, {1, 2, 4, 7}},
          {3, 7, {1, 3, 6, 7}},
          {1, 3, {1, 2, 3}},
          {2, 2, {1, 2}},
          {20, 1, {1}}}) {
        ScheduleOptions options{.passLength = pass, .cap = cap, .worstFirst = true};
        Schedule schedule({{0, 0}, {8, 8}}, options);
        std::vector<int> found;
        for (const Tile& tile : RunAll(schedule, Never)) found.push_back(tile.first + tile.count);
        EXPECT_EQ(found, ends) << pass << " " << cap;
        options.worstFirst = false;
        EXPECT_EQ(PassEndAfter(0, options), std::min(pass, cap));
        options.inSteps = true;  // for who looks at it
        EXPECT_EQ(PassEndAfter(0, options), ends.front());
    }
}

TEST(Schedule, TakesEachStepOfAllBlocksBeforeTheNext) {
    Schedule schedule(
        {{0, 0}, {50, 30}},
        {.blockSize = 16, .passLength = 20, .cap = 20, .smallestSide = 15, .inSteps = true});
    int first = 0;
    for (const Tile& tile : RunAll(schedule, Never)) {
        EXPECT_GE(tile.first, first);
        first = tile.first;
    }
    EXPECT_EQ(first, 8);
    EXPECT_TRUE(schedule.Done());
}

// Where steps have ended, a render without a clock goes on to the ends of whole passes.
TEST(Schedule, KeepsToMultiplesOfPasses) {
    const ScheduleOptions options{.passLength = 20, .cap = 90};
    EXPECT_EQ(PassEndAfter(4, options), 20);
    EXPECT_EQ(PassEndAfter(50, options), 60);
    EXPECT_EQ(PassEndAfter(80, options), 90);
    for (const int spp : {20, 60, 90}) EXPECT_TRUE(IsPassEnd(spp, options)) << spp;
    for (const int spp : {1, 8, 89}) EXPECT_FALSE(IsPassEnd(spp, options)) << spp;
}

TEST(Schedule, CompletesPassesThatWereBegun) {
    const std::vector<BlockStart> starts = {{.spp = 4, .passEnd = 20}, {.spp = 40, .passEnd = 60}};
    Schedule schedule({{0, 0}, {16, 8}},
                      {.blockSize = 8, .passLength = 20, .cap = 90, .worstFirst = true}, starts);
    schedule.CallTime();
    EXPECT_EQ(RunAll(schedule, Never).size(), 2u);
    EXPECT_EQ(schedule.Blocks()[0].spp, 20);
    EXPECT_EQ(schedule.Blocks()[1].spp, 60);
}

TEST(Schedule, StopsBlocksIndependently) {
    Schedule schedule({{0, 0}, {32, 8}}, {.blockSize = 8, .passLength = 20, .cap = 200});
    auto stop = [](int block, int spp) { return spp >= 40 * (block + 1); };
    const std::vector<Tile> tiles = RunAll(schedule, stop);
    for (int i = 0; i < 4; ++i) {
        EXPECT_EQ(schedule.Blocks()[i].spp, 40 * (i + 1));
        EXPECT_TRUE(schedule.Blocks()[i].stoppedByVote);
    }
    EXPECT_EQ(tiles.size(), 2u + 4u + 6u + 8u);
    EXPECT_EQ(schedule.SamplesToCap(), 0);
    EXPECT_EQ(schedule.StoppedBlocks(), 4);
    EXPECT_EQ(schedule.MedianSpp(), 120);
}

// No barrier: a block whose pass is done goes on though another's first tile is still out.
TEST(Schedule, LetsNoBlockWaitForAnother) {
    Schedule schedule({{0, 0}, {16, 8}}, {.blockSize = 8, .cap = 100});
    const Tile slow = *schedule.Next();
    int others = 0;
    while (const auto tile = schedule.Next()) {
        EXPECT_NE(tile->block, slow.block);
        ++others;
        ASSERT_TRUE(schedule.Finish(*tile));
        schedule.Decide(tile->block, false);
    }
    EXPECT_EQ(others, 5);
    EXPECT_FALSE(schedule.Done());
    schedule.Finish(slow);
    schedule.Decide(slow.block, true);
    EXPECT_TRUE(schedule.Done());
}

// Blocks wait for each other at the ends of rounds, those that have stopped for nobody.
TEST(Schedule, WaitsForTheEndOfARound) {
    const ScheduleOptions options{.blockSize = 20, .cap = 100, .smallestSide = 10, .roundEnd = 8};
    Schedule schedule({{0, 0}, {45, 20}}, options);  // the third block follows the second
    std::vector<int> ends;
    const auto stop = [&](int block, int spp) {
        if (block == 1) ends.push_back(spp);
        return block == 0 && spp == 20;
    };
    EXPECT_FALSE(schedule.IsRoundOver());
    for (const int end : {8, 16, 50, kNoRoundEnd}) {
        schedule.BeginRound(end);
        for (const Tile& tile : RunAll(schedule, stop)) EXPECT_LE(tile.first + tile.count, end);
        EXPECT_EQ(schedule.IsRoundOver(), end != kNoRoundEnd);
        if (end == kNoRoundEnd) continue;
        EXPECT_EQ(schedule.Blocks()[1].spp, end);
        EXPECT_EQ(schedule.Blocks()[2].spp, end);
    }
    EXPECT_TRUE(schedule.Done());
    EXPECT_EQ(schedule.Blocks()[0].spp, 20);
    EXPECT_EQ(ends, (std::vector{8, 16, 20, 40, 50, 60, 80, 100}));
}

TEST(Schedule, PrefersTheBlockWithTheFewestSamples) {
    Schedule schedule({{0, 0}, {24, 8}}, {.blockSize = 8, .cap = 60});
    std::vector<int> spp;
    for (const Tile& tile : RunAll(schedule, Never)) spp.push_back(tile.first);
    EXPECT_TRUE(std::is_sorted(spp.begin(), spp.end()));
}

TEST(Schedule, WaitsForTheDecision) {
    Schedule schedule({{0, 0}, {8, 8}}, {});
    const Tile tile = *schedule.Next();
    EXPECT_FALSE(schedule.Next());
    EXPECT_TRUE(schedule.Finish(tile));
    EXPECT_FALSE(schedule.Next());
    schedule.Decide(0, false);
    EXPECT_EQ(schedule.Next()->first, 20);
}

// Whoever is first, followers end at their leader's spp.
TEST(Schedule, EndsFollowersWithTheirLeader) {
    for (const bool followersLast : {false, true}) {
        Schedule schedule(
            {{0, 0}, {110, 100}},
            {.blockSize = 100, .passLength = 20, .cap = 100, .tileSize = 100, .smallestSide = 40});
        std::vector<Tile> held;
        auto finish = [&](const Tile& tile) {
            if (schedule.Finish(tile))
                schedule.Decide(tile.block, schedule.Blocks()[tile.block].spp == 60);
        };
        while (const auto tile = schedule.Next())
            if (followersLast && tile->block == 1)
                held.push_back(*tile);
            else
                finish(*tile);
        for (const Tile& tile : held) finish(tile);
        while (const auto tile = schedule.Next()) finish(*tile);
        EXPECT_TRUE(schedule.Done());
        EXPECT_EQ(schedule.Blocks()[0].spp, 60);
        EXPECT_EQ(schedule.Blocks()[1].spp, 60);
        EXPECT_TRUE(schedule.Blocks()[1].stoppedByVote);
    }
}

TEST(Schedule, LetsSmallBlocksWithoutALeaderGoToTheCap) {
    Schedule schedule({{0, 0}, {30, 30}}, {.cap = 100, .smallestSide = 40});
    RunAll(schedule, [](int, int) { return true; });
    EXPECT_EQ(schedule.Blocks()[0].spp, 100);
    EXPECT_FALSE(schedule.Blocks()[0].stoppedByVote);
}

TEST(Schedule, HasNothingToDoForAnEmptyRegion) {
    Schedule schedule({{3, 3}, {3, 9}}, {});
    EXPECT_TRUE(schedule.Done());
    EXPECT_FALSE(schedule.Next());
    EXPECT_EQ(schedule.MedianSpp(), 0);
}

}  // namespace
}  // namespace lull
