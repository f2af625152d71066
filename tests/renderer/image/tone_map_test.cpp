#include "renderer/image/grade.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace lull {
namespace {

// Values of Hable's formula, computed by hand.
TEST(FilmicToneMap, IsHablesCurve) {
    EXPECT_EQ(FilmicToneMap(0), 0);
    EXPECT_NEAR(FilmicToneMap(0.18f), 0.1283f, 2e-4f);
    EXPECT_NEAR(FilmicToneMap(1), 0.4929f, 2e-4f);
    EXPECT_NEAR(FilmicToneMap(5.6f), 1, 1e-6f);  // the white point at twice the exposure
}

TEST(FilmicToneMap, RisesAndStaysFinite) {
    float last = -1;
    for (float x = 1e-6f; x < 1e30f; x *= 1.5f) {
        const float y = FilmicToneMap(x);
        EXPECT_GE(y, last) << x;
        last = y;
    }
    EXPECT_LT(last, 1.3f);
    EXPECT_EQ(FilmicToneMap(-1), 0);
    EXPECT_EQ(FilmicToneMap(std::nanf("")), 0);
    EXPECT_TRUE(std::isfinite(FilmicToneMap(std::numeric_limits<float>::infinity())));
}

}  // namespace
}  // namespace lull
