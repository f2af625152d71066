// Renders by simulated clocks, on which every sample takes the same time.
#include <gtest/gtest.h>

#include <atomic>
#include <cstring>
#include <ctime>
#include <memory>

#include "renderer/progress/forecast.h"
#include "renderer/render/render.h"
#include "stopping/rules/baselines.h"
#include "tests/renderer/render/synthetic_samples.h"

namespace lull {
namespace {

// Blocks of 20x20 pixels in a row, of which block i has noise of 1, 2, 4, ...
struct Clocked {
    Film film{{{0, 0}, {80, 20}}};
    std::atomic<int64_t> taken = 0;
    RenderOptions setup;
    RenderState state;  // of its checkpoint
    RenderResult result;

    // `samples` is how many fit in the time; 0: all. Goes on from `before`, if that is given.
    explicit Clocked(int64_t samples, int threads = 1, const Clocked* before = nullptr,
                     const std::function<void(RenderOptions*)>& change = {}) {
        setup.schedule = {.blockSize = 20, .passLength = 20, .cap = 4000, .smallestSide = 10};
        setup.sampler = Sampler(SamplerKind::Random, 0);
        setup.threads = threads;
        setup.film = &film;
        if (before) {
            film = before->film;
            setup.interrupted = &before->state;
        }
        setup.checkpoints.write = [this](const RenderState& s) { state = s; };
        if (samples > 0)
            setup.secondsLeft = [this, samples] { return double(samples - taken) / 1e6; };
        setup.makeCriterion = [](const BlockInfo&) {
            return MakeCriterion(LightnessNoiseRule(0.07));
        };
        if (change) change(&setup);
        setup.source = [this](Sampler& sampler, const Vec2i& pixel, uint32_t index,
                              PathSample* sample) {
            ++taken;
            sampler.StartSample(pixel, index);
            const float deviation = 0.02f * float(1 << (pixel.x() / 20));
            sample->radiance = Rgb(1, 1, 1) * (0.4f + deviation * (sampler.Get1D() - 0.5f));
        };
        result = Render(setup);
    }

    int Spp(int block) const { return result.blocks[size_t(block)].block.spp; }
    double Noise(int block) const { return result.blocks[size_t(block)].block.noise; }
};

int64_t Pixels(int passes) { return int64_t(passes) * 20 * 20 * 20; }

void ExpectEvenBlocks(const Clocked& render) {
    for (const BlockResult& b : render.result.blocks)
        for (int y = b.block.pixels.min.y(); y < b.block.pixels.max.y(); ++y)
            for (int x = b.block.pixels.min.x(); x < b.block.pixels.max.x(); ++x)
                ASSERT_EQ(int(render.film.At({x, y}).count), b.block.spp);
}

TEST(Clock, EndsOnTimeWithWholePasses) {
    for (const int threads : {1, 3}) {
        const int64_t time = Pixels(30) + 777;
        const Clocked render(time, threads);
        EXPECT_TRUE(render.result.timeUp);
        EXPECT_FALSE(render.result.cancelled);
        EXPECT_GE(render.taken, time);
        EXPECT_LT(render.taken, time + threads * 8 * 8 * 20);
        ExpectEvenBlocks(render);
        EXPECT_EQ(render.result.progress.samples, render.film.SampleCount());
        // What was undone is less than a pass for each thread.
        EXPECT_GT(render.film.SampleCount(), time - Pixels(threads));
    }
}

TEST(Clock, MakesTheWorstBlockAsGoodAsItCanBe) {
    const Clocked render(Pixels(60));
    for (int i = 0; i < 3; ++i) EXPECT_LE(render.Spp(i), render.Spp(i + 1)) << i;
    EXPECT_GT(render.Spp(3), 2 * render.Spp(2));
    // At equal samples the worst is a good deal noisier.
    const Clocked even(0, 1, nullptr, [](RenderOptions* o) {
        o->schedule.cap = 60 / 4 * 20;
        o->makeCriterion = nullptr;
        o->secondsLeft = [] { return 1.0; };
    });
    EXPECT_EQ(even.Spp(3), 300);
    EXPECT_LT(render.Noise(3), 0.8 * even.Noise(3));
    EXPECT_FALSE(even.result.timeUp);
}

TEST(Clock, LeavesTheStopsOfTheRule) {
    const Clocked reference(0);
    ASSERT_EQ(reference.result.progress.stoppedBlocks, 4);
    // With enough time, all is as without a clock; with less, what has stopped is.
    const int64_t all = reference.film.SampleCount();
    const Clocked enough(all + 1);
    EXPECT_FALSE(enough.result.timeUp);
    EXPECT_TRUE(SamePixels(enough.film, reference.film));
    const Clocked less(all * 3 / 4, 2);
    EXPECT_TRUE(less.result.timeUp);
    for (int i = 0; i < 4; ++i) {
        const Block& block = less.result.blocks[size_t(i)].block;
        if (block.stopped)
            EXPECT_EQ(block.spp, reference.Spp(i));
        else
            EXPECT_LT(block.spp, reference.Spp(i));
    }
}

TEST(Clock, CanBeRepeatedFromTheSamplesOfEachBlock) {
    const Clocked render(Pixels(45) + 1234, 2);
    ASSERT_TRUE(render.result.timeUp);
    const Clocked again(0, 2, nullptr, [&](RenderOptions* o) {
        o->makeCriterion = [&](const BlockInfo& info) {
            return std::make_unique<ScriptedCriterion>(render.Spp(info.index));
        };
    });
    EXPECT_TRUE(SamePixels(again.film, render.film));
}

TEST(Clock, TakesOneSampleOfEachPixelWhateverItTakes) {
    const Clocked render(1);
    EXPECT_TRUE(render.result.timeUp);
    for (int i = 0; i < 4; ++i) EXPECT_EQ(render.Spp(i), 1);
    EXPECT_EQ(render.taken, Pixels(4) / 20);
    ExpectEvenBlocks(render);
}

// And goes on to the same bits without a clock, with the rule asked only where passes end.
TEST(Clock, EndsWithinTheFirstPassWhereThereIsNoTimeForIt) {
    const int64_t times[] = {Pixels(4) / 4, Pixels(4) / 2, Pixels(4) * 9 / 10};
    for (const auto& [time, threads] :
         {std::pair(times[0], 1), {times[1], 1}, {times[2], 1}, {times[1], 2}}) {
        const Clocked render(time, threads);
        EXPECT_TRUE(render.result.timeUp);
        EXPECT_LT(render.taken, time + 2 * 8 * 8 * 20);
        ExpectEvenBlocks(render);
        // How far two threads get depends on when the machine lets them run.
        if (threads == 1) {
            EXPECT_GT(render.film.SampleCount(), time / 4);
            for (int i = 0; i < 4; ++i) EXPECT_GE(render.Spp(i), 4);
        }
        for (const BlockResult& b : render.result.blocks)
            for (const BlockDecision& decision : b.decisions) EXPECT_EQ(decision.spp, 20);

        const Clocked whole(0, threads, &render), reference(0);
        EXPECT_TRUE(SamePixels(whole.film, reference.film));
        for (size_t i = 0; i < 4; ++i)
            EXPECT_EQ(whole.result.blocks[i].decisions.size(),
                      reference.result.blocks[i].decisions.size());
    }
}

// A render without a clock is cut off within a pass; what goes on by the clock completes it.
TEST(Clock, GoesOnFromInterruptedRenders) {
    const Clocked first(0, 1, nullptr, [](RenderOptions* o) {
        o->isCancelled = [calls = std::make_shared<int>(0)] { return ++*calls > 50; };
    });
    EXPECT_TRUE(first.result.cancelled);
    const Clocked timed(Pixels(9), 2, &first);
    EXPECT_TRUE(timed.result.timeUp);
    for (const BlockResult& b : timed.result.blocks) EXPECT_GE(b.block.spp, 20);
    ExpectEvenBlocks(timed);
    // And what the clock has ended goes on to the same bits without.
    EXPECT_TRUE(SamePixels(Clocked(0, 2, &timed).film, Clocked(0).film));
}

TEST(Clock, TakesBlocksOfAnySize) {
    const Clocked render(Pixels(6), 1, nullptr,
                         [](RenderOptions* o) { o->schedule.blockSize = 7; });
    EXPECT_TRUE(render.result.timeUp);
    for (const BlockResult& b : render.result.blocks) EXPECT_TRUE(std::isfinite(b.block.noise));
}

TEST(TimeLimit, ReadsDurations) {
    EXPECT_EQ(ParseDuration("90s"), 90);
    EXPECT_EQ(ParseDuration("10"), 10);
    EXPECT_EQ(ParseDuration("2.5"), 2.5);
    EXPECT_EQ(ParseDuration("10m"), 600);
    EXPECT_EQ(ParseDuration("2h"), 7200);
    EXPECT_EQ(ParseDuration("1h30m"), 5400);
    EXPECT_EQ(ParseDuration("1h0m5s"), 3605);
    EXPECT_EQ(ParseDuration("0.5m"), 30);
    EXPECT_EQ(ParseDuration("1ms"), 0.001);
    EXPECT_EQ(ParseDuration("2s500ms"), 2.5);
    for (const char* bad : {"", "1h30", "m", "10x", "-5s", "0s", "10m1h", "5m5m", "nans", "infs",
                            "1e3s", "10 m", "99999999h", "10m ", "1sm", "1ms1s"})
        EXPECT_THROW(ParseDuration(bad), std::invalid_argument) << bad;
}

TEST(TimeLimit, FindsTheNextTimeOfDay) {
    const std::time_t now = 1700000000;
    std::tm local = {};
    localtime_r(&now, &local);
    for (const char* text : {"00:00", "09:00", "23:59:59", "12:30:01"}) {
        const std::time_t time = NextTimeOfDay(text, now);
        EXPECT_GT(time, now);
        EXPECT_LE(time, now + 25 * 3600);
        std::tm then = {};
        localtime_r(&time, &then);
        char shown[16];
        std::strftime(shown, sizeof shown, "%H:%M:%S", &then);
        EXPECT_EQ(std::string(shown).substr(0, std::strlen(text)), text);
    }
    for (const char* bad : {"", "9:00", "24:00", "09:60", "09:00:60", "09", "09:0", "09:00:", "x",
                            "09:00:00:00", "-1:00", "09-00"})
        EXPECT_THROW(NextTimeOfDay(bad, now), std::invalid_argument) << bad;
}

}  // namespace
}  // namespace lull
