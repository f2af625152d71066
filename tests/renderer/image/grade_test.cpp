#include "renderer/image/image_io.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "renderer/base/math.h"

namespace lull {
namespace {

struct HalvingView final : ViewTransform {
    void Apply(float* rgb, size_t pixels) const override {
        for (size_t i = 0; i < 3 * pixels; ++i) rgb[i] /= 2;
    }
    const char* Name() const override { return "screen/half"; }
};

std::vector<float> Shown(const Grade& grade, std::vector<float> rgb) {
    ApplyGrade(grade, rgb);
    return rgb;
}

TEST(Grade, LeavesColoursAsTheyAre) {
    EXPECT_TRUE(Grade().IsPlain());
    EXPECT_EQ(TextOf(Grade()), "");
    EXPECT_EQ(Shown({}, {0, 0.25f, 7}), (std::vector<float>{0, 0.25f, 7}));
}

TEST(Grade, Brightens) {
    const Grade grade{.exposure = 2};
    EXPECT_FALSE(grade.IsPlain());
    EXPECT_EQ(TextOf(grade), "+2 stops");
    EXPECT_EQ(Shown(grade, {0, 0.25f, 7}), (std::vector<float>{0, 1, 28}));
    const std::vector<float> odd = Shown(grade, {-1, std::nanf(""), kInfinity});
    EXPECT_EQ(odd[0], 0);
    EXPECT_EQ(odd[1], 0);
    EXPECT_TRUE(std::isfinite(odd[2]));
}

TEST(Grade, MapsTonesOfBrightenedColours) {
    const Grade grade{.toneMap = ToneMap::Filmic, .exposure = -1};
    EXPECT_EQ(TextOf(grade), "filmic (Hable 2010), -1 stops");
    EXPECT_EQ(Shown(grade, {0.5f, 2, kInfinity}),
              (std::vector<float>{FilmicToneMap(0.25f), FilmicToneMap(1), FilmicToneMap(1e9f)}));
}

// What a view encodes, a display decodes.
TEST(Grade, ShowsWhatAViewEncodes) {
    const Grade grade{.view = std::make_shared<HalvingView>(), .exposure = 1};
    EXPECT_EQ(TextOf(grade), "OpenColorIO screen/half, +1 stops");
    const std::vector<float> shown = Shown(grade, {0.25f, 5, -1});
    EXPECT_FLOAT_EQ(shown[0], LinearFromSrgb(0.25f));
    EXPECT_EQ(shown[1], 1);
    EXPECT_EQ(shown[2], 0);
}

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
    EXPECT_TRUE(std::isfinite(FilmicToneMap(kInfinity)));
}

}  // namespace
}  // namespace lull
