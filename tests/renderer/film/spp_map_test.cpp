#include "renderer/film/spp_map.h"

#include <gtest/gtest.h>

#include "renderer/base/color.h"

namespace lull {
namespace {

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
