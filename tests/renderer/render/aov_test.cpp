// Layers go the way of the image: any threads and blocks, clocks, checkpoints.
#include <gtest/gtest.h>

#include <atomic>

#include "renderer/render/session.h"
#include "tests/renderer/files/test_files.h"
#include "tests/renderer/film/add_sample.h"
#include "tests/renderer/render/synthetic_samples.h"

namespace lull::aov_test {
namespace {

const PixelRect kRegion = {{5, 3}, {75, 63}};
const std::vector<std::string> kLayers = {"albedo", "normal",   "depth", "position",
                                          "object", "material", "noise"};

struct Rendered {
    Film film;
    RenderOptions options;
    RenderResult result;

    explicit Rendered(const AovSet& aovs = ParseAovs(kLayers))
        : film(kRegion, {.layers = {.aovs = aovs}}) {
        options.schedule = {.blockSize = 30, .passLength = 6, .cap = 60};
        options.sampler = Sampler(SamplerKind::Random, 0);
        options.threads = 1;
        options.makeCriterion = [](const BlockInfo& block) {
            return std::make_unique<ScriptedCriterion>(12 * (block.index + 1));
        };
        options.source = SyntheticSample;
        options.film = &film;
    }
    void Run() { result = Render(options); }
};

// Adds the same samples one by one.
Film Expected(const Film& film) {
    Film expected(kRegion, {.layers = film.layers.Options()});
    Sampler sampler(SamplerKind::Random, 0);
    for (int y = kRegion.min.y(); y < kRegion.max.y(); ++y)
        for (int x = kRegion.min.x(); x < kRegion.max.x(); ++x)
            for (uint32_t k = 0; k < film.At({x, y}).count; ++k) {
                PathSample sample{.asksForHit = true};
                SyntheticSample(sampler, {x, y}, k, &sample);
                expected.layers.Add({x, y}, sample);
                AddTo(&expected, {x, y}, sample.radiance, sample.rejected);
            }
    return expected;
}

TEST(Aovs, HaveTheSamplesOfEachBlockForAnyThreads) {
    for (const int threads : {1, 3, 8}) {
        Rendered render;
        render.options.threads = threads;
        render.Run();
        EXPECT_LT(render.result.blocks[0].block.spp, render.result.blocks[4].block.spp);
        EXPECT_TRUE(SameSums(render.film, Expected(render.film)));
        Film without(kRegion);
        Render(Onto(&without, render.options));
        EXPECT_TRUE(SamePixels(render.film, without));
    }
}

TEST(Aovs, OfNoiseAloneAskForNoFirstHits) {
    for (const bool withDepth : {false, true}) {
        Rendered render({.depth = withDepth, .noise = true});
        render.options.schedule.cap = 6;
        int64_t asked = 0;
        render.options.source = [&](Sampler& sampler, const Vec2i& pixel, uint32_t k,
                                    PathSample* sample) {
            asked += sample->asksForHit;
            SyntheticSample(sampler, pixel, k, sample);
        };
        render.Run();
        EXPECT_EQ(asked, withDepth ? render.film.SampleCount() : 0);
        EXPECT_GT(render.film.layers.Find<SquareLayer>()->At(kRegion.min), 0);
    }
}

// Passes that the time does not suffice for are undone in the layers as well.
TEST(Aovs, AreThoseOfTheImageWhenTheTimeIsUp) {
    Rendered render;
    std::atomic<int> taken = 0;
    render.options.threads = 2;
    render.options.makeCriterion = nullptr;
    render.options.secondsLeft = [&] { return taken < 100000 ? 1. : 0.; };
    render.options.source = Counted(&taken);
    render.Run();
    EXPECT_TRUE(render.result.timeUp);
    EXPECT_LT(render.film.SampleCount(), taken);  // some were undone
    EXPECT_TRUE(SameSums(render.film, Expected(render.film)));
}

// Those that a render asks for must be in the checkpoint; others there are left out.
TEST(Aovs, CanBeLeftOutAfterACheckpoint) {
    const TemporaryDirectory directory;
    const std::string path = directory.File("c.h5");
    const RenderIdentity identity = {{"scene", "a"}};
    Rendered first, fewer({.depth = true, .noise = true});
    first.options.schedule.cap = 12;
    first.options.checkpoints = {
        [&](const RenderState& s) { WriteCheckpoint(path, identity, s, first.film); }, 1e6, true};
    first.Run();
    const RenderState state = ReadCheckpoint(path, identity, &fewer.film);
    EXPECT_TRUE(SameSums(fewer.film, Expected(fewer.film)));
    EXPECT_EQ(fewer.film.SampleCount(), first.film.SampleCount());

    WriteCheckpoint(path, identity, state, fewer.film);
    for (const AovSet& more : {AovSet{.albedo = true}, AovSet{.alpha = true}})
        EXPECT_HAS(ErrorOf([&] {
                       Rendered other(more);
                       ReadCheckpoint(path, identity, &other.film);
                   }),
                   "it was written without the ");
    Rendered through({.depth = true, .throughSpecular = true});
    EXPECT_THROW(ReadCheckpoint(path, identity, &through.film), Error);
}

}  // namespace
}  // namespace lull::aov_test
