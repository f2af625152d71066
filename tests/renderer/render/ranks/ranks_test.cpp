// Renders are the same with any number of ranks, whatever happens to these.
#include <gtest/gtest.h>

#include <atomic>

#include "renderer/render/ranks/rank.h"
#include "stopping/rules/baselines.h"
#include "tests/renderer/render/ranks/shared_render.h"

namespace lull::ranks_test {
namespace {

// Lets blocks stop at the samples that they have had in a render that was short of time.
void StopAs(const RenderResult& result, RenderSetup* setup) {
    setup->schedule.smallestSide = 0;
    setup->schedule.passLength = 1;  // the time may have ended within the first pass
    setup->makeCriterion = [&](const BlockInfo& block) {
        return std::make_unique<ScriptedCriterion>(result.blocks[size_t(block.index)].block.spp);
    };
}

std::vector<int> StopsOf(const Shared& shared) {
    std::vector<int> stops;
    for (const BlockResult& b : shared.result.blocks)
        stops.push_back(b.block.stoppedByVote ? b.block.spp : -b.block.spp);
    return stops;
}

TEST(Ranks, ComeToTheSameBits) {
    const Shared reference = RenderShared(0);
    ASSERT_EQ(reference.result.blocks.size(), 9u);
    for (const auto& [ranks, threads] : {std::pair(1, 1), {2, 3}, {3, 4}, {4, 5}}) {
        const Shared shared =
            RenderShared(ranks, [threads = threads](RenderSetup* o, int) { o->threads = threads; });
        EXPECT_TRUE(SamePixels(*shared.film, *reference.film)) << ranks << " " << threads;
        EXPECT_EQ(StopsOf(shared), StopsOf(reference)) << ranks;
        EXPECT_EQ(shared.result.progress.samples, reference.film->SampleCount());
        EXPECT_FALSE(shared.result.cancelled);
        for (size_t i = 0; i < 9; ++i)
            EXPECT_EQ(shared.result.blocks[i].decisions.size(),
                      reference.result.blocks[i].decisions.size());
    }
}

// There are ranks without a tile, and rules that look at nothing.
TEST(Ranks, CanBeMoreThanTiles) {
    const auto change = [](RenderSetup* o, int) {
        o->schedule = {.blockSize = 10, .cap = 20, .tileSize = 8};
        o->makeCriterion = nullptr;
    };
    EXPECT_TRUE(SamePixels(*RenderShared(5, change).film, *RenderShared(0, change).film));
}

// What criteria are shown is the same numbers.
TEST(Ranks, ShowCriteriaTheSame) {
    const auto change = [](RenderSetup* o, int) {
        o->makeCriterion = [](const BlockInfo&) { return MakeCriterion(LightnessNoiseRule(12)); };
    };
    const Shared one = RenderShared(0, change), three = RenderShared(3, change);
    for (size_t i = 0; i < one.result.blocks.size(); ++i) {
        const auto &a = one.result.blocks[i].decisions, &b = three.result.blocks[i].decisions;
        ASSERT_EQ(a.size(), b.size());
        for (size_t k = 0; k < a.size(); ++k) {
            EXPECT_EQ(a[k].spp, b[k].spp);
            EXPECT_EQ(a[k].decision.value, b[k].decision.value);
        }
    }
}

// Returns what cancels the last of the ranks after a while.
auto SignalToLast(int ranks) {
    return [ranks](RenderSetup* o, int rank) {
        if (rank != ranks - 1) return;
        o->isCancelled = [calls = std::make_shared<std::atomic<int>>(0), ranks] {
            return ++*calls > 150 / ranks;
        };
    };
}

// Interrupted with some ranks, by a signal to one of them, and taken up by others.
TEST(Ranks, GoOnFromCheckpointsOfOthers) {
    const Shared reference = RenderShared(0);
    for (const auto& [first, second] : {std::pair(1, 3), {2, 0}, {4, 2}}) {
        const Shared begun = RenderShared(first, SignalToLast(first));
        ASSERT_TRUE(begun.result.cancelled);
        EXPECT_LT(begun.film->SampleCount(), reference.film->SampleCount());
        const Shared ended = RenderShared(second, {}, &begun);
        EXPECT_TRUE(SamePixels(*ended.film, *reference.film)) << first << " " << second;
        EXPECT_EQ(StopsOf(ended), StopsOf(reference));
    }
}

TEST(Ranks, PauseForCheckpoints) {
    const Shared reference = RenderShared(0);
    std::atomic<int> checkpoints = 0;
    const auto change = [&](RenderSetup* o, int rank) {
        if (rank > 0) return;
        o->checkpoints.interval = 0.002;
        o->checkpoints.write = [&](const RenderState&) { ++checkpoints; };
    };
    // Takes many times the interval, however fast the machine is.
    const SampleSource slow = [](Sampler& sampler, const Vec2i& pixel, uint32_t index,
                                 PathSample* sample) {
        if (pixel.x() == kImage.min.x() && index % 5 == 0)
            std::this_thread::sleep_for(std::chrono::milliseconds(1));
        SyntheticSample(sampler, pixel, index, sample);
    };
    const Shared shared = RenderShared(3, change, nullptr, [&](int) { return slow; });
    EXPECT_GT(checkpoints, 2);
    EXPECT_TRUE(SamePixels(*shared.film, *reference.film));
    EXPECT_EQ(StopsOf(shared), StopsOf(reference));
}

// Others are quiet, and say so, before rank 0 has looked for messages.
TEST(Ranks, MayAnswerAtOnce) {
    const auto change = [](RenderSetup* o, int) { o->makeCriterion = nullptr; };
    const auto nap = std::chrono::milliseconds(20);
    EXPECT_TRUE(SamePixels(*RenderShared(2, change, nullptr, SameForAll, {.nap = nap}).film,
                           *RenderShared(0, change).film));
}

// The clock of rank 0 is that of all.
TEST(Ranks, EndByTheClockWithWholePasses) {
    for (const int64_t time : {int64_t(1), kImage.Area() * 35}) {
        std::atomic<int64_t> taken = 0;
        const auto source = [&](Sampler& sampler, const Vec2i& pixel, uint32_t index,
                                PathSample* sample) {
            ++taken;
            SyntheticSample(sampler, pixel, index, sample);
        };
        const Shared shared = RenderShared(
            3,
            [&](RenderSetup* o, int rank) {
                o->makeCriterion = nullptr;
                o->secondsLeft = [&taken, time, rank] {
                    return rank > 0 ? 1 : double(time - taken);
                };
            },
            nullptr, [&](int) { return source; });
        EXPECT_TRUE(shared.result.timeUp);
        const Shared again =
            RenderShared(2, [&](RenderSetup* o, int) { StopAs(shared.result, o); });
        EXPECT_TRUE(SamePixels(*again.film, *shared.film));
        // How far each has got by then is for the machine to decide.
        for (const BlockResult& b : shared.result.blocks) EXPECT_GE(b.block.spp, 1);
    }
}

TEST(Ranks, PassOnWhatTasksThrow) {
    Mailboxes mail;
    mail.boxes.resize(2);
    QueuePeers peers(&mail, 0);
    RenderOptions options = SharedOptions();
    options.peers = &peers;
    Film film(kImage);
    const auto broken = [](Sampler&, const Vec2i&, uint32_t, PathSample*) -> void {
        throw std::bad_alloc();
    };
    EXPECT_THROW(Render({.source = broken, .film = &film}, options), std::bad_alloc);
}

TEST(Ranks, DealOutEveryTileOnce) {
    const PixelRect block{{5, 5}, {49, 62}};
    for (const int ranks : {1, 2, 5, 100}) {
        int64_t area = 0;
        size_t least = 1000, most = 0;
        for (int rank = 0; rank < ranks; ++rank) {
            const std::vector<PixelRect> tiles = TilesOf(block, 3, 8, {rank, EvenDeal(ranks)});
            for (const PixelRect& tile : tiles) area += tile.Area();
            least = std::min(least, tiles.size());
            most = std::max(most, tiles.size());
        }
        EXPECT_EQ(area, block.Area());
        EXPECT_LE(most - least, 1u);
    }
    int64_t area = 0;
    for (int rank = 0; rank < 3; ++rank)
        for (const PixelRect& tile : TilesOf(block, 300, 8, {rank, DealBySpeed({1, 2, 5})}))
            area += tile.Area();
    EXPECT_EQ(area, block.Area());
}

// Takes a nap at the first sample of each pixel's pass, on those ranks and in those passes that
// `isSlow(rank, index)` is true for.
SourceOfRank SlowWhere(const std::function<bool(int rank, uint32_t index)>& isSlow) {
    return [isSlow](int rank) -> SampleSource {
        return [=](Sampler& sampler, const Vec2i& pixel, uint32_t index, PathSample* sample) {
            if (index % 20 == 0 && isSlow(rank, index))
                std::this_thread::sleep_for(std::chrono::microseconds(100));
            SyntheticSample(sampler, pixel, index, sample);
        };
    };
}

TEST(Ranks, MoveTilesToWhereThereIsTime) {
    const Shared reference = RenderShared(0);
    const auto change = [](RenderSetup* o, int) { o->dealInterval = 0.02; };
    for (const int ranks : {2, 3, 4}) {
        const Shared shared =
            RenderShared(ranks, change, nullptr,
                         SlowWhere([ranks](int rank, uint32_t) { return rank == ranks - 1; }));
        EXPECT_TRUE(SamePixels(*shared.film, *reference.film)) << ranks;
        EXPECT_EQ(StopsOf(shared), StopsOf(reference)) << ranks;
        ASSERT_EQ(shared.result.shares.size(), size_t(ranks));
        EXPECT_LT(shared.result.shares.back(), 0.7 / ranks);
    }
}

// Tiles go to and fro, with a clock and checkpoints, too.
TEST(Ranks, MoveTilesAsOftenAsSpeedsChange) {
    const auto source =
        SlowWhere([](int rank, uint32_t index) { return rank == int(index / 20) % 3; });
    const Shared reference = RenderShared(0);
    int checkpoints = 0;
    const Shared moved = RenderShared(
        3,
        [&](RenderSetup* o, int rank) {
            o->dealInterval = 0;
            o->secondsLeft = [] { return 1000.0; };
            if (rank > 0) return;
            o->checkpoints.interval = 0.02;
            o->checkpoints.write = [&](const RenderState&) { ++checkpoints; };
        },
        nullptr, source);
    EXPECT_TRUE(SamePixels(*moved.film, *reference.film));
    EXPECT_EQ(StopsOf(moved), StopsOf(reference));
    EXPECT_GT(checkpoints, 0);
}

Shared RenderLayers(int ranks, const Change& change = {}, const Shared* before = nullptr,
                    const SourceOfRank& sourceOf = SameForAll) {
    return RenderShared(ranks, change, before, sourceOf, {}, true);
}

void ExpectSameLayers(const Shared& shared, const Shared& reference, int ranks) {
    EXPECT_TRUE(SamePixels(*shared.film, *reference.film)) << ranks;
    EXPECT_TRUE(SameSums(*shared.film, *reference.film)) << ranks;
    EXPECT_EQ(StopsOf(shared), StopsOf(reference)) << ranks;
}

TEST(Ranks, ShareLayers) {
    const Shared reference = RenderLayers(0);
    EXPECT_TRUE(SamePixels(*reference.film, *RenderShared(0).film));
    for (const auto& [ranks, threads] : {std::pair(1, 2), {2, 3}, {3, 4}, {3, 7}})
        ExpectSameLayers(
            RenderLayers(ranks, [n = threads](RenderSetup* o, int) { o->threads = n; }), reference,
            ranks);
}

TEST(Ranks, GoOnWithTheLayersOfOthers) {
    const Shared reference = RenderLayers(0);
    for (const auto& [first, second] : {std::pair(1, 3), {3, 2}, {2, 0}}) {
        const Shared begun = RenderLayers(first, SignalToLast(first));
        ASSERT_TRUE(begun.result.cancelled);
        ExpectSameLayers(RenderLayers(second, {}, &begun), reference, second);
    }
}

TEST(Ranks, MoveLayersWithTheirTiles) {
    const auto source =
        SlowWhere([](int rank, uint32_t index) { return rank == int(index / 20) % 3; });
    const auto change = [](RenderSetup* o, int) { o->dealInterval = 0; };
    ExpectSameLayers(RenderLayers(3, change, nullptr, source), RenderLayers(0), 3);
}

struct GivenUp {
    std::vector<int> ranks;

    // Returns what has ranks given up soon.
    Change Soon(const Change& change = {}) {
        return [this, change](RenderSetup* o, int rank) {
            o->rankPatience = 2;
            o->events.onGivenUp = [this](int given, double) { ranks.push_back(given); };
            if (change) change(o, rank);
        };
    }
};

// One falls asleep at the beginning, amid the passes, and when many blocks have stopped; with
// checkpoints rank 0 has some of its samples.
TEST(Ranks, GoOnWithoutOneThatSleeps) {
    const Shared reference = RenderLayers(0);
    for (const auto& [messages, interval] :
         {std::pair(0, 60.0), {3, 0.002}, {12, 60.0}, {25, 0.002}}) {
        GivenUp givenUp;
        const Shared shared =
            RenderShared(3, givenUp.Soon([seconds = interval](RenderSetup* o, int) {
                o->checkpoints.interval = seconds;
            }),
                         nullptr, SameForAll, {.sleeper = 2, .messagesBefore = messages}, true);
        ExpectSameLayers(shared, reference, messages);
        EXPECT_EQ(givenUp.ranks, std::vector<int>{2}) << messages;
        EXPECT_EQ(shared.result.shares.at(2), 0);
        EXPECT_EQ(shared.result.progress.samples, reference.film->SampleCount());
    }
}

// What is left of the time does not leave holes, nor parts of passes.
TEST(Ranks, EndByTheClockWithoutOneThatSleeps) {
    for (const int messages : {0, 8, 20}) {
        std::atomic<int64_t> taken = 0;
        const auto source = [&](Sampler& sampler, const Vec2i& pixel, uint32_t index,
                                PathSample* sample) {
            ++taken;
            SyntheticSample(sampler, pixel, index, sample);
        };
        GivenUp givenUp;
        const Shared shared = RenderShared(3, givenUp.Soon([&](RenderSetup* o, int rank) {
            o->makeCriterion = nullptr;
            o->secondsLeft = [&taken, rank] {
                return rank > 0 ? 1 : double(kImage.Area() * 35 - taken);
            };
        }),
                                           nullptr, [&](int) { return source; },
                                           {.sleeper = 1, .messagesBefore = messages});
        EXPECT_EQ(givenUp.ranks, std::vector<int>{1}) << messages;
        EXPECT_FALSE(shared.result.cancelled);
        for (const BlockResult& b : shared.result.blocks)
            for (int y = b.block.pixels.min.y(); y < b.block.pixels.max.y(); ++y)
                for (int x = b.block.pixels.min.x(); x < b.block.pixels.max.x(); ++x)
                    ASSERT_EQ(int(shared.film->At({x, y}).count), b.block.spp);
        for (const BlockResult& b : shared.result.blocks) EXPECT_GE(b.block.spp, 1);
    }
}

// Passes that the time does not suffice for are undone in the layers of all ranks.
TEST(Ranks, UndoLayers) {
    const int64_t time = kImage.Area() * 35;
    bool undone = false;
    for (int attempt = 0; attempt < 20 && !undone; ++attempt) {
        std::atomic<int64_t> taken = 0;
        const auto source = [&](int) -> SampleSource {
            return [&](Sampler& sampler, const Vec2i& pixel, uint32_t index, PathSample* sample) {
                if (++taken > time && index % 20 == 0)
                    std::this_thread::sleep_for(std::chrono::microseconds(100));
                SyntheticSample(sampler, pixel, index, sample);
            };
        };
        const Shared timed = RenderLayers(
            3,
            [&](RenderSetup* o, int rank) {
                o->schedule.tileSize = 4;
                o->makeCriterion = nullptr;
                o->secondsLeft = [&, rank] { return rank > 0 ? 1 : double(time - taken); };
            },
            nullptr, source);
        undone = timed.film->SampleCount() < taken;
        const Shared again = RenderLayers(0, [&](RenderSetup* o, int) { StopAs(timed.result, o); });
        EXPECT_TRUE(SamePixels(*timed.film, *again.film));
        EXPECT_TRUE(SameSums(*timed.film, *again.film));
    }
    EXPECT_TRUE(undone);
}

}  // namespace
}  // namespace lull::ranks_test
