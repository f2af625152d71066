#include "renderer/learning/trial.h"

#include <gtest/gtest.h>

namespace lull {
namespace {

// A film of 16 tiles in each of two blocks.
Film TwoBlocks() {
    return Film({{0, 0}, {32, 16}}, {.grid = {.blockSize = 16, .tileSize = 4}, .withHalf = false});
}

const PixelRect kLeft = {{0, 0}, {16, 16}}, kRight = {{16, 0}, {32, 16}};

// Calls set(tile's noise, whether it is in the right block) for each tile.
std::vector<TileNoise> NoiseOf(const Film& film, const auto& set) {
    std::vector<TileNoise> noise(film.TileCount());
    for (int y = 0; y < 16; y += 4)
        for (int x = 0; x < 32; x += 4) set(&noise[film.TileAt({x, y})], x >= 16);
    return noise;
}

TEST(VarianceOf, IsThatOfThePart) {
    const Film film = TwoBlocks();
    const auto noise = NoiseOf(film, [](TileNoise* tile, bool isRight) {
        *tile = {.unguided = 4, .guided = isRight ? 3.f : 2.f};
    });
    EXPECT_DOUBLE_EQ(VarianceOf(noise, film, kLeft), 0.25);
    EXPECT_DOUBLE_EQ(VarianceOf(noise, film, kRight), 0.5625);
    const double both = VarianceOf(noise, film, film.Region());
    EXPECT_GT(both, 0.390625);  // the ratio of the means, and doubt
    EXPECT_LT(both, 0.55);
}

TEST(VarianceOf, AllowsForDoubt) {
    const Film film = TwoBlocks();
    for (const float scatter : {0.2f, 0.8f}) {
        int n = 0;
        const auto noise = NoiseOf(film, [&](TileNoise* tile, bool) {
            *tile = {.unguided = 4, .guided = 2 + (n++ % 2 ? scatter : -scatter)};
        });
        // 16 tiles with this deviation: the ratio has an error of scatter / 4 / sqrt(15).
        const double error = double(scatter) / 4 / std::sqrt(15);
        EXPECT_NEAR(VarianceOf(noise, film, kLeft), 0.25 + 2 * 0.5 * error, 1e-6);
    }
}

TEST(VarianceOf, IsOneWhereNothingIsSure) {
    const Film film = TwoBlocks();
    EXPECT_EQ(VarianceOf({}, film, kLeft), 1);
    const auto worse =
        NoiseOf(film, [](TileNoise* tile, bool) { *tile = {.unguided = 2, .guided = 4}; });
    EXPECT_EQ(VarianceOf(worse, film, kLeft), 1);
    int n = 0;
    const auto few = NoiseOf(film, [&](TileNoise* tile, bool isRight) {
        if (!isRight && n++ < kTilesEnough - 1) *tile = {.unguided = 4, .guided = 2};
    });
    EXPECT_EQ(VarianceOf(few, film, kLeft), 1);
    EXPECT_EQ(VarianceOf(few, film, kRight), 1);
    const auto dark = NoiseOf(film, [](TileNoise* tile, bool) { *tile = {.unguided = 4}; });
    EXPECT_GT(VarianceOf(dark, film, kLeft), 0);
}

// Samples of two kinds, counted in tiles; what has samples of one kind only counts for nothing.
TEST(GuideTally, TellsNoiseInLightness) {
    Film film = TwoBlocks();
    for (int y = 0; y < 16; ++y)
        for (int x = 0; x < 32; ++x) {
            FilmPixel pixel;
            pixel.Add(x < 16 ? Rgb(0.5f, 0.5f, 0.5f) : Rgb(2, 2, 2), false);  // which is white
            film.Tile(film.Region()).Set({x, y}, pixel);
        }
    GuideTally tally;
    tally.unguided.assign(film.TileCount(),
                          {.squares = 400, .freedom = 100, .vertices = 300, .samples = 100});
    tally.guided.assign(film.TileCount(),
                        {.squares = 100, .freedom = 100, .vertices = 330, .samples = 100});
    const size_t stopped = film.TileAt({0, 0});
    tally.guided[stopped] = {};
    const std::vector<TileNoise> noise = tally.Noise(film);
    ASSERT_EQ(noise.size(), film.TileCount());
    EXPECT_EQ(noise[stopped].unguided, 0);
    const TileNoise grey = noise[film.TileAt({8, 8})], white = noise[film.TileAt({24, 8})];
    EXPECT_NEAR(grey.unguided, 2 * 116. / 3 * std::pow(0.5, -2. / 3), 1e-3);
    EXPECT_NEAR(grey.guided, grey.unguided / 2, 1e-4);
    EXPECT_EQ(white.unguided, 0);
    const GuideComparison c = tally.Compare(noise);
    EXPECT_NEAR(c.variance, 0.25, 1e-6);
    EXPECT_NEAR(c.error, 0, 1e-6);
    EXPECT_NEAR(c.vertices, 1.1, 1e-9);
    EXPECT_NEAR(VarianceOf(noise, film, kLeft), 0.25, 1e-6);
    EXPECT_EQ(VarianceOf(noise, film, kRight), 1);
}

}  // namespace
}  // namespace lull
