#include "renderer/film/film.h"

#include <gtest/gtest.h>

#include "renderer/base/math.h"
#include "renderer/film/spp_map.h"
#include "tests/renderer/film/add_sample.h"

namespace lull {
namespace {

TEST(InHalf, IsCountedAndSplitsEveryMultipleOfFourSamplesEvenly) {
    uint32_t inHalf = 0;
    for (uint32_t n = 0; n <= 10000; ++n) {
        ASSERT_EQ(HalfCount(n), inHalf) << n;
        if (n % 4 == 0) {
            ASSERT_EQ(inHalf, n / 2) << n;
        }
        inHalf += InHalf(n);
    }
}

TEST(InHalf, FollowsTheParityOfTheOddBits) {
    const bool expected[] = {0, 0, 1, 1, 0, 0, 1, 1, 1, 1, 0, 0, 1, 1, 0, 0};
    for (uint32_t k = 0; k < 16; ++k) EXPECT_EQ(InHalf(k), expected[k]) << k;
    EXPECT_TRUE(InHalf(0x80000000u));
    EXPECT_FALSE(InHalf(0x40000000u));
}

TEST(FilmPixel, KeepsSumsOfAllAndOfTheHalf) {
    FilmPixel pixel;
    Rgb all(0, 0, 0), half(0, 0, 0);
    for (uint32_t k = 0; k < 20; ++k) {
        const Rgb radiance(float(k), float(2 * k), 1);
        pixel.Add(radiance, k == 7);
        all += radiance;
        if (InHalf(k)) half += radiance;
    }
    EXPECT_EQ(pixel.count, 20u);
    EXPECT_EQ(pixel.rejected, 1u);
    EXPECT_TRUE((pixel.Mean() == all / 20).all());
    EXPECT_TRUE((pixel.HalfMean() == half / 10).all());
}

TEST(FilmPixel, HasMeansFromTheFirstSampleOn) {
    FilmPixel pixel;
    EXPECT_TRUE(IsBlack(pixel.Mean()));
    EXPECT_TRUE(IsBlack(pixel.HalfMean()));
    pixel.Add(Rgb(1, 2, 3), false);
    EXPECT_TRUE((pixel.Mean() == Rgb(1, 2, 3)).all());
    EXPECT_TRUE((pixel.HalfMean() == Rgb(1, 2, 3)).all());
}

// A float sum would have stopped growing at 2^24.
TEST(FilmPixel, LosesNothingOverManySamples) {
    FilmPixel pixel;
    pixel.sum = {0x1p24, 0x1p24, 0x1p24};
    pixel.Add(Rgb(1, 1, 1), false);
    EXPECT_EQ(pixel.sum[0], 0x1p24 + 1);
}

TEST(Film, AddressesPixelsOfTheFullImage) {
    Film film({{10, 20}, {14, 23}});
    for (int y = 20; y < 23; ++y)
        for (int x = 10; x < 14; ++x) AddTo(&film, {x, y}, Rgb(float(x), float(y), 0));
    const std::vector<float> mean = film.MeanImage();
    ASSERT_EQ(mean.size(), 4u * 3u * 3u);
    EXPECT_EQ(mean[0], 10);
    EXPECT_EQ(mean[1], 20);
    EXPECT_EQ(mean[3 * 5], 11);  // the second pixel of the second row
    EXPECT_EQ(mean[3 * 5 + 1], 21);
    EXPECT_EQ(film.SampleCount(), 12);
}

TEST(Film, ExtractsRectanglesIntoBuffersOfAnyFormerSize) {
    Film film({{0, 0}, {5, 4}});
    for (int y = 0; y < 4; ++y)
        for (int x = 0; x < 5; ++x)
            for (int k = 0; k < 4; ++k)
                AddTo(&film, {x, y}, Rgb(float(x), float(y), InHalf(k) ? 2.f : 0.f));
    FilmView view;
    film.Extract({{0, 0}, {5, 4}}, true, &view);
    film.Extract({{2, 1}, {4, 3}}, true, &view);
    EXPECT_EQ(view.width, 2);
    EXPECT_EQ(view.height, 2);
    EXPECT_EQ(view.mean, (std::vector<float>{2, 1, 1, 3, 1, 1, 2, 2, 1, 3, 2, 1}));
    EXPECT_EQ(view.halfMean, (std::vector<float>{2, 1, 2, 3, 1, 2, 2, 2, 2, 3, 2, 2}));
    film.Extract({{2, 1}, {4, 3}}, false, &view);
    EXPECT_TRUE(view.halfMean.empty());
}

TEST(Film, CountsRejectedSamples) {
    Film film({{0, 0}, {2, 1}});
    AddTo(&film, {0, 0}, Rgb(0, 0, 0), true);
    AddTo(&film, {1, 0}, Rgb(0, 0, 0), true);
    AddTo(&film, {1, 0}, Rgb(1, 1, 1));
    EXPECT_EQ(film.RejectedCount(), 2);
}

// Adds `samples` to all pixels, block by block and in these tile by tile.
void AddByTiles(Film* film, const TileGrid& grid, int samples) {
    const PixelRect& all = film->Region();
    const auto forEachPart = [](const PixelRect& whole, int size, const auto& visit) {
        for (int y = whole.min.y(); y < whole.max.y(); y += size)
            for (int x = whole.min.x(); x < whole.max.x(); x += size)
                visit(PixelRect{{x, y}, Vec2i(x + size, y + size).cwiseMin(whole.max)});
    };
    forEachPart(all, grid.blockSize, [&](const PixelRect& block) {
        forEachPart(block, grid.tileSize, [&](const PixelRect& tile) {
            FilmTile pixels = film->Tile(tile);
            forEachPart(tile, 1, [&](const PixelRect& pixel) {
                FilmPixel sums = pixels.At(pixel.min);
                const uint32_t end = sums.count + uint32_t(samples);
                while (sums.count < end)
                    sums.Add(Rgb(float(pixel.min.x()), float(pixel.min.y()), float(sums.count)),
                             (pixel.min.x() + pixel.min.y()) % 3 == 0);
                pixels.Set(pixel.min, sums);
            });
        });
    });
}

// What is known by tile is what is known by pixel.
TEST(Film, KeepsTheSameByTiles) {
    const PixelRect region{{3, 5}, {40, 31}};
    for (const TileGrid grid : {TileGrid{25, 8}, {10, 16}, {1, 8}, {200, 8}, {8, 8}}) {
        Film byTile(region, {.grid = grid}), byPixel(region);
        for (const int samples : {20, 7}) {
            AddByTiles(&byTile, grid, samples);
            AddByTiles(&byPixel, grid, samples);
        }
        for (int y = region.min.y(); y < region.max.y(); ++y)
            for (int x = region.min.x(); x < region.max.x(); ++x) {
                const FilmPixel a = byTile.At({x, y}), b = byPixel.At({x, y});
                ASSERT_EQ(a.sum, b.sum);
                ASSERT_EQ(a.halfSum, b.halfSum);
                ASSERT_EQ(a.count, 27u);
            }
        EXPECT_EQ(byTile.RejectedCount(), byPixel.RejectedCount());
        EXPECT_EQ(byTile.SampleCount(), byPixel.SampleCount());
        EXPECT_EQ(byTile.MeanImage(), byPixel.MeanImage());
    }
}

TEST(Film, TakesThePixelsOfATileInAnyOrder) {
    const PixelRect region{{0, 0}, {6, 6}}, second{{4, 0}, {6, 4}};
    const std::vector<Vec2i> places = {{5, 3}, {4, 0}, {4, 2}, {5, 1},
                                       {4, 1}, {5, 0}, {4, 3}, {5, 2}};
    Film film(region, {.grid = {.blockSize = 6, .tileSize = 4}});
    for (const uint32_t end : {3u, 5u}) {
        FilmTile tile = film.Tile(second);
        for (const Vec2i& p : places) {
            FilmPixel pixel = tile.At(p);
            EXPECT_EQ(pixel.count, end == 3 ? 0u : 3u);  // though others have more already
            while (pixel.count < end) pixel.Add(Rgb(float(p.x()), float(p.y()), 1), p.x() == 4);
            tile.Set(p, pixel);
        }
    }
    EXPECT_EQ(film.RejectedCount(), 4 * 5);
    EXPECT_EQ(film.SampleCount(), 8 * 5);
    for (const Vec2i& p : places)
        EXPECT_EQ(film.At(p).sum, (std::array<double, 3>{5. * p.x(), 5. * p.y(), 5}));
    EXPECT_EQ(film.At({3, 0}).count, 0u);
    EXPECT_EQ(film.At({4, 4}).count, 0u);
}

TEST(Film, LeavesOutTheHalfWhereItIsNotWanted) {
    const PixelRect region{{0, 0}, {800, 600}};
    const TileGrid grid{200, 8};
    EXPECT_EQ(Film::Bytes(region, {grid, true}), region.Area() * 48 + 100 * 75 * 8);
    EXPECT_EQ(Film::Bytes(region, {grid, false}), region.Area() * 24 + 100 * 75 * 8);

    Film film({{0, 0}, {2, 1}}, {.withHalf = false});
    for (int k = 0; k < 4; ++k) AddTo(&film, {1, 0}, Rgb(1, 2, float(k)));
    FilmView view;
    film.Extract(film.Region(), false, &view);
    EXPECT_EQ(view.mean, (std::vector<float>{0, 0, 0, 1, 2, 1.5f}));
    EXPECT_THROW(film.Extract(film.Region(), true, &view), std::logic_error);
    Film other({{0, 0}, {2, 1}});
    other.DropHalf();
    EXPECT_THROW(other.Extract(other.Region(), true, &view), std::logic_error);
}

// What makes the map readable for everyone, and in grey.
TEST(Viridis, GrowsSteadilyLighter) {
    float last = -1;
    for (int i = 0; i <= 100; ++i) {
        const Rgb c = Viridis(float(i) / 100);
        EXPECT_TRUE((c >= 0).all() && (c <= 1).all());
        const float y = Luminance(c.unaryExpr([](float v) { return LinearFromSrgb(v); }));
        EXPECT_GT(y, last) << i;
        last = y;
    }
}

TEST(Viridis, IsClampedBeyondItsEnds) {
    EXPECT_TRUE((Viridis(-1) == Viridis(0)).all());
    EXPECT_TRUE((Viridis(7) == Viridis(1)).all());
}

// Returns sRGB values in [0, 1].
Rgb At(const SppMap& map, int x, int y) {
    const uint8_t* pixel = &map.srgb[3 * (size_t(y) * size_t(map.width) + size_t(x))];
    return Rgb(pixel[0], pixel[1], pixel[2]) / 255;
}

bool Shows(const SppMap& map, int x, int y, const Rgb& color) {
    return ((At(map, x, y) - color).abs() < 0.6f / 255).all();
}

TEST(DrawSppMap, ColoursBlocksByTheLogarithmOfTheirSpp) {
    const std::vector<SppBlock> blocks = {{{{100, 50}, {300, 250}}, 20},
                                          {{{300, 50}, {500, 250}}, 10000}};
    const SppMap map = DrawSppMap({{100, 50}, {500, 250}}, blocks, 20, 10000);
    EXPECT_EQ(map.width, 400);
    EXPECT_GT(map.height, 200);
    EXPECT_TRUE(Shows(map, 5, 5, Viridis(0)));
    EXPECT_TRUE(Shows(map, 205, 5, Viridis(1)));
    // The line between the blocks is darker than both.
    EXPECT_LT(Luminance(At(map, 199, 5)), Luminance(At(map, 5, 5)));
    // The bar below runs from one end of the scale to the other.
    EXPECT_TRUE(Shows(map, 0, 210, Viridis(0)));
    EXPECT_TRUE(Shows(map, 399, 210, Viridis(1)));
}

// At the cap, some blocks have stopped there, and others would have gone on.
TEST(DrawSppMap, FramesBlocksThatWouldHaveGoneOn) {
    const std::vector<SppBlock> blocks = {{{{0, 0}, {100, 100}}, 600},
                                          {{{100, 0}, {200, 100}}, 600, true}};
    const SppMap map = DrawSppMap({{0, 0}, {200, 100}}, blocks, 20, 600);
    const auto isRed = [&](int x, int y) { return At(map, x, y).x() > 3 * At(map, x, y).y(); };
    for (const Vec2i& at : {Vec2i(0, 0), Vec2i(50, 0), Vec2i(0, 50), Vec2i(98, 98)})
        EXPECT_FALSE(isRed(at.x(), at.y())) << at.transpose();
    for (const Vec2i& at : {Vec2i(100, 0), Vec2i(150, 0), Vec2i(199, 50), Vec2i(150, 99)})
        EXPECT_TRUE(isRed(at.x(), at.y())) << at.transpose();
    EXPECT_FALSE(isRed(150, 80));
}

TEST(DrawSppMap, HoldsAnySize) {
    for (const Vec2i& size : {Vec2i(1, 1), Vec2i(3, 700), Vec2i(1000, 2), Vec2i(17, 33)})
        for (const int highest : {1, 20, 16777216}) {
            const PixelRect region{{0, 0}, size};
            const std::vector<SppBlock> blocks = {{region, highest}};
            const SppMap map = DrawSppMap(region, blocks, 1, highest);
            EXPECT_EQ(map.srgb.size(), size_t(map.width) * size_t(map.height) * 3);
            EXPECT_EQ(map.width, size.x());
            EXPECT_GT(map.height, size.y());
        }
}

}  // namespace
}  // namespace lull
