#include "renderer/image/grade.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "renderer/base/color.h"

namespace lull {
namespace {

struct HalvingView final : ViewTransform {
    void Apply(float* rgb, size_t pixels) const override {
        for (size_t i = 0; i < 3 * pixels; ++i) rgb[i] /= 2;
    }
    const char* Name() const override { return "screen/half"; }
};

constexpr float kInfinity = std::numeric_limits<float>::infinity();

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

}  // namespace
}  // namespace lull
