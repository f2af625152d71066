// Renders are the same with any number of ranks, whatever happens to these.
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>

#include "renderer/render/ranks/rank.h"
#include "stopping/rules/baselines.h"
#include "tests/renderer/render/ranks/shared_render.h"
#include "tests/renderer/scene_of.h"

namespace lull::ranks_test {
namespace {

std::vector<int> StopsOf(const Shared& shared) {
    std::vector<int> stops;
    for (const BlockResult& b : shared.result.blocks)
        stops.push_back(b.block.stoppedByVote ? b.block.spp : -b.block.spp);
    return stops;
}

// Expects the same sums, of layers as well, and stops.
void ExpectSame(const Shared& shared, const Shared& reference, int what) {
    EXPECT_TRUE(SameSums(*shared.film, *reference.film)) << what;
    EXPECT_EQ(StopsOf(shared), StopsOf(reference)) << what;
}

TEST(Ranks, ComeToTheSameBits) {
    const Shared reference = RenderShared(0);
    ASSERT_EQ(reference.result.blocks.size(), 9u);
    for (const auto& [ranks, threads] : {std::pair(1, 1), {2, 3}, {3, 4}, {4, 5}}) {
        const Shared shared = RenderShared(
            ranks, [threads = threads](RenderOptions* o, int) { o->threads = threads; });
        ExpectSame(shared, reference, ranks);
        EXPECT_EQ(shared.result.progress.samples, reference.film->SampleCount());
        EXPECT_FALSE(shared.result.cancelled);
        for (size_t i = 0; i < 9; ++i)
            EXPECT_EQ(shared.result.blocks[i].decisions.size(),
                      reference.result.blocks[i].decisions.size());
    }
}

// There are ranks without a tile, and rules that look at nothing.
TEST(Ranks, CanBeMoreThanTiles) {
    const auto change = [](RenderOptions* o, int) {
        o->schedule = {.blockSize = 10, .cap = 20, .tileSize = 8};
        o->makeCriterion = nullptr;
    };
    ExpectSame(RenderShared(5, change), RenderShared(0, change), 5);
}

// What criteria are shown is the same numbers.
TEST(Ranks, ShowCriteriaTheSame) {
    const auto change = [](RenderOptions* o, int) {
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

// Interrupted with some ranks, by a signal to one of them, and taken up by others.
TEST(Ranks, GoOnFromCheckpointsOfOthers) {
    const Shared reference = RenderShared(0);
    for (const auto& [first, second] : {std::pair(1, 3), {2, 0}, {4, 2}}) {
        std::atomic<int> calls = 0;
        const Shared begun = RenderShared(first, [&, ranks = first](RenderOptions* o, int rank) {
            if (rank == ranks - 1) o->isCancelled = [&, ranks] { return ++calls > 150 / ranks; };
        });
        ASSERT_TRUE(begun.result.cancelled);
        EXPECT_LT(begun.film->SampleCount(), reference.film->SampleCount());
        ExpectSame(RenderShared(second, {}, &begun), reference, second);
    }
}

TEST(Ranks, PauseForCheckpoints) {
    const Shared reference = RenderShared(0);
    std::atomic<int> checkpoints = 0;
    const auto change = [&](RenderOptions* o, int rank) {
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
    ExpectSame(shared, reference, 3);
}

// Others are quiet, and say so, before rank 0 has looked for messages.
TEST(Ranks, MayAnswerAtOnce) {
    const auto change = [](RenderOptions* o, int) { o->makeCriterion = nullptr; };
    const auto nap = std::chrono::milliseconds(20);
    ExpectSame(RenderShared(2, change, nullptr, SameForAll, {.nap = nap}), RenderShared(0, change),
               2);
}

// The clock of rank 0 is that of all. Passes that the time does not suffice for are undone.
TEST(Ranks, EndByTheClockWithWholePasses) {
    bool undone = false;
    for (int attempt = 0; attempt < 20 && !undone; ++attempt)
        for (const int64_t time : {int64_t(1), kImage.Area() * 35}) {
            std::atomic<int64_t> taken = 0;
            const auto source = [&](Sampler& sampler, const Vec2i& pixel, uint32_t index,
                                    PathSample* sample) {
                if (taken > time && index % 20 == 0)
                    std::this_thread::sleep_for(std::chrono::microseconds(100));
                Counted (&taken)(sampler, pixel, index, sample);
            };
            const Shared timed = RenderShared(
                3,
                [&](RenderOptions* o, int rank) {
                    o->schedule.tileSize = 4;
                    o->makeCriterion = nullptr;
                    o->secondsLeft = [&taken, time, rank] {
                        return rank > 0 ? 1 : double(time - taken);
                    };
                },
                nullptr, [&](int) { return source; });
            EXPECT_TRUE(timed.result.timeUp);
            undone |= timed.film->SampleCount() < taken;
            // Blocks stop at the samples that they have had.
            const Shared again = RenderShared(2, [&](RenderOptions* o, int) {
                o->schedule.smallestSide = 0;
                o->schedule.passLength = 1;  // the time may have ended within the first pass
                o->makeCriterion = [&](const BlockInfo& block) {
                    const BlockResult& stopped = timed.result.blocks[size_t(block.index)];
                    return std::make_unique<ScriptedCriterion>(stopped.block.spp);
                };
            });
            EXPECT_TRUE(SameSums(*again.film, *timed.film));
            // How far each has got by then is for the machine to decide.
            for (const BlockResult& b : timed.result.blocks) EXPECT_GE(b.block.spp, 1);
        }
    EXPECT_TRUE(undone);
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
    EXPECT_THROW(Render(Onto(&film, options, broken)), std::bad_alloc);
}

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
    const auto change = [](RenderOptions* o, int) { o->dealInterval = 0.02; };
    for (const int ranks : {2, 3, 4}) {
        const Shared shared =
            RenderShared(ranks, change, nullptr,
                         SlowWhere([ranks](int rank, uint32_t) { return rank == ranks - 1; }));
        ExpectSame(shared, reference, ranks);
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
        [&](RenderOptions* o, int rank) {
            o->dealInterval = 0;
            o->secondsLeft = [] { return 1000.0; };
            if (rank > 0) return;
            o->checkpoints.interval = 0.02;
            o->checkpoints.write = [&](const RenderState&) { ++checkpoints; };
        },
        nullptr, source);
    ExpectSame(moved, reference, 3);
    EXPECT_GT(checkpoints, 0);
}

struct GivenUp {
    std::vector<int> ranks;

    // Returns what has ranks given up soon.
    Change Soon(const Change& change = {}) {
        return [this, change](RenderOptions* o, int rank) {
            o->rankPatience = 2;
            o->events.onGivenUp = [this](int given, double) { ranks.push_back(given); };
            if (change) change(o, rank);
        };
    }
};

// One falls asleep at the beginning, amid the passes, and when many blocks have stopped; with
// checkpoints rank 0 has some of its samples.
TEST(Ranks, GoOnWithoutOneThatSleeps) {
    const Shared reference = RenderShared(0);
    for (const auto& [messages, interval] :
         {std::pair(0, 60.0), {3, 0.002}, {12, 60.0}, {25, 0.002}}) {
        GivenUp givenUp;
        const Shared shared =
            RenderShared(3, givenUp.Soon([seconds = interval](RenderOptions* o, int) {
                o->checkpoints.interval = seconds;
            }),
                         nullptr, SameForAll, {.sleeper = 2, .messagesBefore = messages});
        ExpectSame(shared, reference, messages);
        EXPECT_EQ(givenUp.ranks, std::vector<int>{2}) << messages;
        EXPECT_EQ(shared.result.shares.at(2), 0);
        EXPECT_EQ(shared.result.progress.samples, reference.film->SampleCount());
    }
}

// What is left of the time does not leave holes, nor parts of passes.
TEST(Ranks, EndByTheClockWithoutOneThatSleeps) {
    for (const int messages : {0, 8, 20}) {
        std::atomic<int64_t> taken = 0;
        GivenUp givenUp;
        const Shared shared = RenderShared(3, givenUp.Soon([&](RenderOptions* o, int rank) {
            o->makeCriterion = nullptr;
            o->secondsLeft = [&taken, rank] {
                return rank > 0 ? 1 : double(kImage.Area() * 35 - taken);
            };
        }),
                                           nullptr, [&](int) { return Counted(&taken); },
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

// Light paths and their shares are the same with any number of ranks.

// A render that is interrupted, goes on, or loses a rank.
struct Part {
    const Shared* before = nullptr;  // goes on from there
    Habits how = {};
    int64_t tiles = 1 << 30;  // of the first rank, which is then interrupted
    int checkpoints = 0;      // after which it is interrupted; 0: it is not
};

Shared RenderPart(const Scene& scene, int ranks, const Part& part = {}) {
    const Film whole(kImage);
    std::vector<std::unique_ptr<LightRounds>> lights(size_t(std::max(1, ranks)));
    for (std::unique_ptr<LightRounds>& light : lights)
        light = std::make_unique<LightRounds>(scene, whole, Sampler(SamplerKind::Random, 0));
    std::atomic<int64_t> left = part.tiles;
    int written = 0;
    const auto change = [&](RenderOptions* o, int rank) {
        o->lightRounds = lights[size_t(rank)].get();
        o->rankPatience = 1;
        o->schedule.cap = 90;
        if (rank > 0) return;
        o->isCancelled = [&] { return --left < 0; };
        if (part.checkpoints == 0) return;
        o->checkpoints.interval = 0;
        o->checkpoints.write = [&, write = o->checkpoints.write](const RenderState& state) {
            write(state);
            if (++written == part.checkpoints) left = 0;
        };
    };
    return RenderShared(
        ranks, change, part.before,
        [&](int rank) { return SamplesOf(scene, Estimator::Combined, lights[size_t(rank)].get()); },
        part.how);
}

// Each traces a part of the light of a round; one of them is given up in a round, or while light is
// traced, and three go on, within a round, from what two had. A ball under a lamp is seen from
// outside.
TEST(Ranks, ShareLightPaths) {
    const auto scene = SceneOf(R"(
Integrator "bdpt" "integer maxdepth" [3]
LookAt 0 0 -3  0 0 0  0 1 0
Camera "perspective" "float fov" [60]
Film "image" "integer xresolution" [80] "integer yresolution" [60]
WorldBegin
LightSource "infinite" "rgb L" [.2 .3 .4]
LightSource "point" "point from" [1 2 -2] "rgb I" [3 3 3]
Shape "sphere" "float radius" [1]
WorldEnd
)");
    const Shared reference = RenderPart(*scene, 0);
    ASSERT_FALSE(reference.result.cancelled);
    for (const int count : {1, 2, 3})
        EXPECT_TRUE(SameSums(*RenderPart(*scene, count).film, *reference.film)) << count;
    for (const int before : {0, 1, 2, 9}) {
        const Shared fewer =
            RenderPart(*scene, 3, {.how = {.sleeper = 1, .messagesBefore = before}});
        EXPECT_TRUE(SameSums(*fewer.film, *reference.film)) << before;
    }
    // Some of these checkpoints are written as a round ends.
    for (int i = 2; i < 40; i += 3) {
        const Shared begun = RenderPart(*scene, 3, {.checkpoints = i});
        const Shared rest = RenderPart(*scene, 2, {.before = &begun});
        EXPECT_TRUE(SameSums(*rest.film, *reference.film)) << i;
    }
    const Shared part = RenderPart(*scene, 2, {.tiles = 400});
    EXPECT_TRUE(part.result.cancelled);
    EXPECT_TRUE(part.state.shares);
    const Shared rest = RenderPart(*scene, 3, {.before = &part});
    EXPECT_FALSE(rest.result.cancelled);
    EXPECT_TRUE(SameSums(*rest.film, *reference.film));
}

}  // namespace

}  // namespace lull::ranks_test
