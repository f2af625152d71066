// What a render keeps for the denoiser: sums by halves, through checkpoints and files, to the bit.
#include "renderer/render/film_picture.h"

#include <gtest/gtest.h>

#include "renderer/base/error.h"
#include "renderer/film/layers.h"
#include "tests/renderer/render/feature_render.h"

namespace lull {
namespace {

TEST(FeatureFilm, IsTheSameForAnyThreads) {
    const FeatureRender one(1), three(3);
    EXPECT_EQ(one.features.Pixels(), three.features.Pixels());
    // The film beside it is what it is without.
    Film film(kPictureRegion);
    RenderOptions options;
    options.schedule = {.blockSize = 30, .passLength = 6, .cap = 36};
    options.makeCriterion = [](const BlockInfo&) {
        return std::make_unique<ScriptedCriterion>(1000);
    };
    Render({.source = SyntheticSample, .film = &film}, options);
    EXPECT_TRUE(SamePixels(one.film, film));
}

TEST(FeatureFilm, GoesThroughCheckpoints) {
    const TemporaryDirectory directory;
    const std::string path = directory.File("c.h5");
    FeatureRender render(1);
    RenderState state;
    state.blocks.push_back({.block = {.pixels = kPictureRegion}, .decisions = {}});
    state.criteria.resize(1);
    WriteCheckpoint(path, {{"seed", "1"}}, state, render.film, {.features = &render.features});
    Film film(kPictureRegion);
    FeatureFilm features(kPictureRegion);
    ReadCheckpoint(path, {{"seed", "1"}}, &film, {.features = &features});
    EXPECT_TRUE(SamePixels(film, render.film));
    EXPECT_EQ(features.Pixels(), render.features.Pixels());

    WriteCheckpoint(path, {{"seed", "1"}}, state, render.film);
    EXPECT_THROW(ReadCheckpoint(path, {{"seed", "1"}}, &film, {.features = &features}), Error);
}

TEST(PictureOf, HasBothHalvesOfTheMean) {
    const FeatureRender render(1);
    const NoisyPicture picture = PictureOf(render.film, render.features, kPictureRegion);
    ASSERT_EQ(picture.colour.a.width, kPictureRegion.Width());
    for (int y = 0; y < 40; ++y)
        for (int x = 0; x < 60; ++x) {
            const Rgb mean = render.film.At({x + 3, y + 5}).Mean();
            for (int c = 0; c < 3; ++c) {
                const float of =
                    (picture.colour.a.Row(c, y)[x] + picture.colour.b.Row(c, y)[x]) / 2;
                EXPECT_NEAR(of, mean[c], 1e-4f * std::abs(mean[c]));
            }
            for (int c = 0; c < picture.features.count; ++c)
                EXPECT_TRUE(std::isfinite(picture.features.Row(c, y)[x]));
            EXPECT_GE(picture.variance.Row(0, y)[x], 0);
        }
}

TEST(PictureOf, LeavesPixelsAloneThatHaveNoHalves) {
    const FeatureRender render(1, 2);
    const NoisyPicture picture = PictureOf(render.film, render.features, kPictureRegion);
    EXPECT_EQ(picture.colour.a.values, picture.colour.b.values);
}

}  // namespace
}  // namespace lull
