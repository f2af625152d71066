// Layers go the way of the image: any threads and blocks, clocks, checkpoints.
#include <gtest/gtest.h>

#include <atomic>

#include "renderer/render/checkpoint.h"
#include "tests/renderer/files/test_files.h"
#include "tests/renderer/render/synthetic_samples.h"

namespace lull::aov_test {
namespace {

const PixelRect kRegion = {{5, 3}, {75, 63}};
const std::vector<std::string> kLayers = {"albedo", "normal",   "depth", "position",
                                          "object", "material", "noise"};

struct Rendered {
    Film film;
    AovFilm aovs;
    RenderSetup options;
    RenderResult result;

    Rendered() : film(kRegion), aovs(kRegion, ParseAovs(kLayers)) {
        options.schedule = {.blockSize = 30, .passLength = 6, .cap = 60};
        options.sampler = SamplerKind::Random;
        options.threads = 1;
        options.makeCriterion = [](const BlockInfo& block) {
            return std::make_unique<ScriptedCriterion>(12 * (block.index + 1));
        };
        options.source = SyntheticSample;
        options.film = &film;
        options.layers = {.aovs = &aovs};
    }
    void Run(const RenderState* interrupted = nullptr) {
        options.interrupted = interrupted;
        result = Render(options, options);
    }
};

// Adds the same samples one by one.
AovFilm Expected(const Film& film, const AovSet& wanted) {
    AovFilm aovs(kRegion, wanted);
    Sampler sampler(SamplerKind::Random, 0);
    for (int y = kRegion.min.y(); y < kRegion.max.y(); ++y)
        for (int x = kRegion.min.x(); x < kRegion.max.x(); ++x)
            for (uint32_t k = 0; k < film.At({x, y}).count; ++k) {
                FirstHit hit;
                const PathSample sample = SyntheticSample(sampler, {x, y}, k, {&hit});
                aovs.At({x, y}).Add(hit, sample.radiance);
            }
    return aovs;
}

TEST(Aovs, HaveTheSamplesOfEachBlockForAnyThreads) {
    for (const int threads : {1, 3, 8}) {
        Rendered render;
        render.options.threads = threads;
        render.Run();
        EXPECT_LT(render.result.blocks[0].block.spp, render.result.blocks[4].block.spp);
        EXPECT_TRUE(SameLayers(render.aovs, Expected(render.film, render.aovs.Wanted())));
        Film without(kRegion);
        Render({.source = SyntheticSample, .film = &without}, render.options);
        EXPECT_TRUE(SamePixels(render.film, without));
    }
}

TEST(Aovs, OfNoiseAloneAskForNoFirstHits) {
    for (const bool withDepth : {false, true}) {
        Rendered render;
        AovFilm aovs(kRegion, {.depth = withDepth, .noise = true});
        render.options.layers = {.aovs = &aovs};
        render.options.schedule.cap = 6;
        int64_t asked = 0;
        render.options.source = [&](Sampler& sampler, const Vec2i& pixel, uint32_t k,
                                    const SampleDetail& detail) {
            asked += detail.firstHit != nullptr;
            return SyntheticSample(sampler, pixel, k, detail);
        };
        render.Run();
        EXPECT_EQ(asked, withDepth ? render.film.SampleCount() : 0);
        EXPECT_GT(aovs.At(kRegion.min).squares, 0);
    }
}

// Passes that the time does not suffice for are undone in the layers as well.
TEST(Aovs, AreThoseOfTheImageWhenTheTimeIsUp) {
    Rendered render;
    std::atomic<int> taken = 0;
    render.options.threads = 2;
    render.options.makeCriterion = nullptr;
    render.options.secondsLeft = [&] { return taken < 100000 ? 1. : 0.; };
    render.options.source = [&](Sampler& sampler, const Vec2i& pixel, uint32_t k,
                                const SampleDetail& detail) {
        ++taken;
        return SyntheticSample(sampler, pixel, k, detail);
    };
    render.Run();
    EXPECT_TRUE(render.result.timeUp);
    EXPECT_LT(render.film.SampleCount(), taken);  // some were undone
    EXPECT_TRUE(SameLayers(render.aovs, Expected(render.film, render.aovs.Wanted())));
}

TEST(Aovs, GoOnFromCheckpoints) {
    const TemporaryDirectory directory;
    const std::string path = directory.File("c.h5");
    const RenderIdentity identity = {{"scene", "a"}};
    Rendered whole;
    whole.Run();
    RenderState state;
    {
        Rendered first;
        std::atomic<int> taken = 0;
        first.options.source = [&](Sampler& s, const Vec2i& pixel, uint32_t k,
                                   const SampleDetail& detail) {
            ++taken;
            return SyntheticSample(s, pixel, k, detail);
        };
        first.options.isCancelled = [&] { return taken > 50001; };
        first.options.checkpoints.write = [&](const RenderState& s) {
            WriteCheckpoint(path, identity, s, first.film, first.options.layers);
        };
        first.options.checkpoints.interval = 1e6;
        first.Run();
        EXPECT_TRUE(first.result.cancelled);
    }
    Rendered second;
    state = ReadCheckpoint(path, identity, &second.film, second.options.layers);
    second.Run(&state);
    EXPECT_TRUE(SamePixels(second.film, whole.film));
    EXPECT_TRUE(SameLayers(second.aovs, whole.aovs));

    // A render without layers goes on from it too, but not the other way round.
    Film film(kRegion);
    state = ReadCheckpoint(path, identity, &film);
    WriteCheckpoint(path, identity, state, film);
    Rendered third;
    EXPECT_THROW(ReadCheckpoint(path, identity, &third.film, third.options.layers), Error);
}

TEST(Aovs, OfAnotherRegionAreRefused) {
    Rendered render;
    AovFilm other({{0, 0}, {1, 1}}, render.aovs.Wanted());
    render.options.layers.aovs = &other;
    EXPECT_THROW(render.Run(), std::invalid_argument);
}

}  // namespace
}  // namespace lull::aov_test
