#include "renderer/render/render.h"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <mutex>
#include <set>
#include <thread>

#include "tests/renderer/render/synthetic_samples.h"

namespace lull {
namespace {

const PixelRect kRegion = {{0, 0}, {131, 97}};

RenderOptions SmallRender() {
    RenderOptions options;
    options.schedule = {.blockSize = 50, .passLength = 20, .cap = 50};
    options.sampler = Sampler(SamplerKind::Random, 0);
    options.threads = 1;
    return options;
}

Film Rendered(const RenderOptions& options, const PixelRect& region = kRegion) {
    Film film(region, {.grid = GridOf(options.schedule)});
    Render(Onto(&film, options));
    return film;
}

TEST(Render, IsTheSameBitsForAnyNumberOfThreads) {
    const Film reference = Rendered(SmallRender());
    EXPECT_EQ(reference.SampleCount(), kRegion.Area() * 50);
    for (const int threads : {2, 4, 16})
        for (int run = 0; run < 3; ++run) {
            RenderOptions options = SmallRender();
            options.threads = threads;
            EXPECT_TRUE(SamePixels(Rendered(options), reference)) << threads;
        }
}

TEST(Render, IsTheSameBitsForAnyBlocksTilesAndPasses) {
    const PixelRect region = {{0, 0}, {70, 37}};
    RenderOptions plain = SmallRender();
    plain.schedule.cap = 26;
    const Film reference = Rendered(plain, region);
    for (const int blockSize : {1, 7, 64, 200})
        for (const int passLength : {1, 3, 20, 1000})
            for (const int tileSize : {5, 16}) {
                RenderOptions options = plain;
                options.threads = 2;
                options.schedule = {.blockSize = blockSize,
                                    .passLength = passLength,
                                    .cap = 26,
                                    .tileSize = tileSize};
                EXPECT_TRUE(SamePixels(Rendered(options, region), reference))
                    << blockSize << " " << passLength;
            }
}

TEST(Render, StopsEachBlockWhenItsCriterionSaysSo) {
    for (const int threads : {1, 4}) {
        RenderOptions options = SmallRender();
        options.threads = threads;
        options.schedule.cap = 200;
        options.makeCriterion = [](const BlockInfo& block) {
            return std::make_unique<ScriptedCriterion>(40 * (block.index + 1));
        };
        Film film(kRegion);
        const RenderResult result = Render(Onto(&film, options));
        ASSERT_EQ(result.blocks.size(), 6u);
        EXPECT_FALSE(result.cancelled);
        for (int i = 0; i < 6; ++i) {
            const BlockResult& block = result.blocks[i];
            EXPECT_EQ(block.block.spp, std::min(200, 40 * (i + 1)));
            EXPECT_EQ(block.block.stoppedByVote, i < 5);
            EXPECT_EQ(int(block.decisions.size()), block.block.spp / 20);
            EXPECT_EQ(int(film.At(block.block.pixels.min).count), block.block.spp);
        }
        EXPECT_EQ(result.progress.samples, film.SampleCount());
    }
}

// Checks what the criterion is shown against the film.
TEST(Render, ShowsCriteriaTheBlockAfterEachPass) {
    struct Witness : Criterion {
        std::vector<int>* spp;
        ViewNeed Need(int at) const override {
            return at == 20 ? ViewNeed::Nothing : at == 40 ? ViewNeed::Mean : ViewNeed::MeanAndHalf;
        }
        Decision Observe(const BlockView& view) override {
            spp->push_back(view.spp);
            EXPECT_EQ(view.width, 60);
            EXPECT_EQ(view.height, 30);
            EXPECT_EQ(view.mean.size(), view.spp == 20 ? 0u : 60u * 30u * 3u);
            EXPECT_EQ(view.halfMean.size(), view.spp < 60 ? 0u : 60u * 30u * 3u);
            return {};
        }
    };
    std::vector<int> spp;
    RenderOptions options = SmallRender();
    options.schedule = {.blockSize = 200, .passLength = 20, .cap = 70};
    options.makeCriterion = [&](const BlockInfo& block) {
        EXPECT_EQ(block.areaFraction, 1);
        auto witness = std::make_unique<Witness>();
        witness->spp = &spp;
        return witness;
    };
    Film film({{5, 5}, {65, 35}});
    const RenderResult result = Render(Onto(&film, options));
    EXPECT_EQ(spp, (std::vector<int>{20, 40, 60, 70}));
    EXPECT_TRUE(result.blocks[0].decisions.empty());  // it never judged
}

// All of four threads meet inside one tile each of the only block: the last live block fills
// every core. Where it did not, those inside would wait in vain.
TEST(Render, SpreadsASingleBlockOverAllThreads) {
    std::mutex mutex;
    std::condition_variable changed;
    std::set<std::thread::id> inside;
    auto meet = [&](Sampler& sampler, const Vec2i& pixel, uint32_t index, PathSample* sample) {
        std::unique_lock lock(mutex);
        inside.insert(std::this_thread::get_id());
        changed.notify_all();
        changed.wait_for(lock, std::chrono::seconds(20), [&] { return inside.size() >= 4; });
        lock.unlock();
        SyntheticSample(sampler, pixel, index, sample);
    };
    RenderOptions options = SmallRender();
    options.threads = 4;
    options.schedule = {.blockSize = 200, .passLength = 4, .cap = 4};
    Film film({{0, 0}, {200, 200}});
    Render(Onto(&film, options, meet));
    EXPECT_EQ(inside.size(), 4u);
}

TEST(Render, EndsAfterTheTilesUnderWayWhenCancelled) {
    std::atomic<int> taken = 0;
    RenderOptions options = SmallRender();
    options.threads = 2;
    options.schedule = {.blockSize = 50, .passLength = 20, .cap = 10000};
    options.isCancelled = [&] { return taken > 400000; };
    Film film(kRegion);
    const RenderResult result = Render(Onto(&film, options, Counted(&taken)));
    EXPECT_TRUE(result.cancelled);
    EXPECT_EQ(film.SampleCount(), taken);
    EXPECT_EQ(result.progress.samples, taken);
    EXPECT_LT(taken, 400000 + 3 * 16 * 16 * 20);
    // All have had their share.
    for (const BlockResult& block : result.blocks) EXPECT_GT(block.block.spp, 0);
}

TEST(Render, PassesOnWhatCriteriaAndSamplesThrow) {
    struct Broken : Criterion {
        ViewNeed Need(int) const override { return ViewNeed::Nothing; }
        Decision Observe(const BlockView&) override { throw std::runtime_error("broken"); }
    };
    RenderOptions options = SmallRender();
    options.threads = 4;
    options.makeCriterion = [](const BlockInfo&) { return std::make_unique<Broken>(); };
    Film film(kRegion);
    EXPECT_THROW(Render(Onto(&film, options)), std::runtime_error);
    const auto broken = [](Sampler&, const Vec2i&, uint32_t, PathSample*) -> void {
        throw std::bad_alloc();
    };
    EXPECT_THROW(Render(Onto(&film, SmallRender(), broken)), std::bad_alloc);
}

TEST(Render, ReportsProgressInOrderAndTheEnd) {
    std::vector<RenderProgress> reports;
    RenderOptions options = SmallRender();
    options.threads = 4;
    options.events.progressInterval = 0;
    options.events.onProgress = [&](const RenderProgress& p) { reports.push_back(p); };
    Rendered(options);
    ASSERT_GT(reports.size(), 2u);
    for (size_t i = 1; i < reports.size(); ++i)
        EXPECT_GE(reports[i].samples, reports[i - 1].samples);
    EXPECT_EQ(reports.back().samples, kRegion.Area() * 50);
    EXPECT_EQ(reports.back().samplesToCap, 0);
    EXPECT_EQ(reports.back().stoppedBlocks, reports.back().blocks);
}

// Stops at `stop` spp by an error that falls with the root of the samples.
struct FallingCriterion final : Criterion {
    explicit FallingCriterion(double stop) : stop(stop) {}
    ViewNeed Need(int) const override { return ViewNeed::Nothing; }
    Decision Observe(const BlockView& view) override {
        const double value = std::sqrt(stop / view.spp);
        return {.stop = value <= 1, .checked = true, .value = value, .threshold = 1};
    }
    double stop;
};

// There is no time before 60 spp, then a range of it; after an interruption once the run has taken
// a sample per pixel.
TEST(Render, PredictsTheTimeOnceThereAreData) {
    RenderOptions options = SmallRender();
    options.schedule.cap = 2000;
    options.trend = RuleTrend();
    options.makeCriterion = [](const BlockInfo&) {
        return std::make_unique<FallingCriterion>(400);
    };
    options.events.progressInterval = 0;
    std::vector<RenderProgress> reports;
    bool isInterrupted = false;
    options.events.onProgress = [&](const RenderProgress& p) {
        reports.push_back(p);
        isInterrupted = p.medianSpp >= 200;
    };
    RenderState state;
    Film film(kRegion);
    const auto check = [&](int64_t before) {
        int predicted = 0;
        for (const RenderProgress& p : reports) {
            const bool isKnown = p.medianSpp >= 60 && p.samples >= before + kRegion.Area();
            if (!isKnown && p.samplesToCap > 0 && p.stoppedBlocks == 0) {
                EXPECT_FALSE(p.predictedSeconds) << p.samples;
            }
            if (!p.secondsRange || p.stoppedBlocks > 0) continue;
            ++predicted;
            EXPECT_NEAR(double(p.samples) + *p.predictedSamples, 400. * double(kRegion.Area()),
                        40. * double(kRegion.Area()));
            EXPECT_LT((*p.secondsRange)[0], *p.predictedSeconds);
            EXPECT_GT((*p.secondsRange)[1], *p.predictedSeconds);
        }
        EXPECT_GT(predicted, 5);
    };
    options.isCancelled = [&] { return isInterrupted; };
    options.checkpoints.write = [&](const RenderState& s) { state = s; };
    EXPECT_TRUE(Render(Onto(&film, options)).cancelled);
    check(0);

    reports.clear();
    const int64_t before = film.SampleCount();
    options.isCancelled = {};
    options.interrupted = &state;
    EXPECT_FALSE(Render(Onto(&film, options)).cancelled);
    check(before);
}

// The first of them come soon, and nothing of the image depends on them.
TEST(Render, ShowsPreviews) {
    for (const int threads : {1, 4}) {
        RenderOptions options = SmallRender();
        options.threads = threads;
        options.schedule.inSteps = true;
        options.events.previewInterval = 0;
        Film film(kRegion, {.grid = GridOf(options.schedule)});
        std::vector<int64_t> samples;
        options.events.onPreview = [&](const RenderResult& result) {
            EXPECT_TRUE(result.cancelled);
            EXPECT_EQ(result.progress.samples, film.SampleCount());
            samples.push_back(film.SampleCount());
        };
        const RenderResult result = Render(Onto(&film, options));
        EXPECT_FALSE(result.cancelled);
        EXPECT_TRUE(SamePixels(film, Rendered(SmallRender())));
        EXPECT_GT(samples.size(), 20u);
        EXPECT_TRUE(std::ranges::is_sorted(samples));
        EXPECT_LE(samples.front(), threads * Sqr(int64_t(options.schedule.tileSize)));
    }
}

// Whoever waits for either does not get both.
TEST(Render, WritesCheckpointsAndPreviewsEachInTheirTime) {
    const auto countAt = [](double previewInterval, double checkpointInterval) {
        int previews = 0, checkpoints = 0;
        RenderOptions options = SmallRender();
        options.events.previewInterval = previewInterval;
        options.events.onPreview = [&](const RenderResult&) { ++previews; };
        Film film(kRegion, {.grid = GridOf(options.schedule)});
        options.checkpoints = {.write = [&](const RenderState&) { ++checkpoints; },
                               .interval = checkpointInterval};
        Render(Onto(&film, options));
        return std::pair(previews, checkpoints);
    };
    const auto [previews, none] = countAt(0, 1e6);
    EXPECT_GT(previews, 20);
    EXPECT_EQ(none, 0);
    const auto [no, checkpoints] = countAt(1e6, 0);
    EXPECT_EQ(no, 0);
    EXPECT_GT(checkpoints, 20);
}

}  // namespace
}  // namespace lull
