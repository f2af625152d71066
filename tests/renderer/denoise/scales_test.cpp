#include "renderer/denoise/scales.h"

#include <gtest/gtest.h>

#include "tests/renderer/denoise/example_pictures.h"

namespace lull {
namespace {

TEST(Scales, HalvesByMeans) {
    const Planes image =
        MakePlanes(5, 3, 2, [](int c, int x, int y) { return 100 * c + 10 * y + x; });
    const Planes half = Halved(image);
    ASSERT_EQ(half.width, 3);
    ASSERT_EQ(half.height, 2);
    EXPECT_FLOAT_EQ(half.Row(0, 0)[0], 5.5f);
    EXPECT_FLOAT_EQ(half.Row(0, 0)[2], 9.f);  // a column alone
    EXPECT_FLOAT_EQ(half.Row(1, 1)[1], 122.5f);
    EXPECT_FLOAT_EQ(half.Row(1, 1)[2], 124.f);
}

TEST(Scales, ReplaceNothingByItself) {
    const Planes image =
        MakePlanes(21, 34, 3, [](int c, int x, int y) { return c + x * 7 % 5 + y * 3 % 11; });
    EXPECT_EQ(WithCoarsePart(image, Halved(image)).values, image.values);
}

// What is wider than two pixels comes from the coarse picture, what is finer stays.
TEST(Scales, ReplaceTheCoarsePart) {
    const auto fine = [](int x, int y) { return (x + y) % 2 * 0.1; };
    const auto wide = [](int x, int y) { return 0.01 * x + 0.02 * y; };
    const auto wrong = [](int x) { return std::sin(x * 0.05); };
    const Planes truth =
        MakePlanes(64, 48, 3, [&](int, int x, int y) { return fine(x, y) + wide(x, y); });
    const Planes off = MakePlanes(
        64, 48, 3, [&](int, int x, int y) { return fine(x, y) + wide(x, y) + wrong(x); });
    EXPECT_GT(Rms(off, truth, 4), 0.3);
    EXPECT_LT(Rms(WithCoarsePart(off, Halved(truth)), truth, 4), 0.002);
}

TEST(Scales, TakePicturesOfAnySize) {
    for (const auto& [width, height] : {std::pair(1, 1), {2, 1}, {1, 3}, {3, 3}}) {
        const Planes image(width, height, 3, 0.5f);
        EXPECT_EQ(WithCoarsePart(Planes(width, height, 3), Halved(image)).values, image.values);
    }
}

TEST(Doubled, KeepsWhatIsSmooth) {
    const Planes image = MakePlanes(31, 17, 2, [](int c, int x, int y) { return c + x + 2 * y; });
    const Planes doubled = Doubled(Halved(image), 31, 17);
    for (int c = 0; c < 2; ++c)
        for (int y = 2; y < 14; ++y)
            for (int x = 2; x < 28; ++x)
                EXPECT_NEAR(doubled.Row(c, y)[x], image.Row(c, y)[x], 1e-4f);
}

}  // namespace
}  // namespace lull
