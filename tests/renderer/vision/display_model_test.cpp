#include "renderer/vision/display_model.h"

#include <gtest/gtest.h>

#include <limits>

#include "renderer/base/error.h"

namespace lull::display_test {
namespace {

TEST(ParseDisplay, ReadsWhatNameOfWrites) {
    const DisplayModel display = ParseDisplay("80lux,55.5ppd,200cd");
    EXPECT_EQ(display.peak, 200);
    EXPECT_EQ(display.pixelsPerDegree, 55.5);
    EXPECT_EQ(display.ambient, 80);
    EXPECT_EQ(NameOf(display), "200cd,55.5ppd,80lux");
    EXPECT_EQ(NameOf(ParseDisplay(NameOf(display))), NameOf(display));
}

TEST(ParseDisplay, KeepsDefaults) {
    EXPECT_EQ(NameOf(ParseDisplay("60ppd")), "100cd,60ppd,250lux");
}

TEST(ParseDisplay, RefusesAllElse) {
    for (const char* text : {"", "100", "cd", "100cd,", ",100cd", "100cd,100cd", "100nits", "1e9cd",
                             "0cd", "nancd", "infcd", "4ppd", "501ppd", "-1lux", "100cd 40ppd"})
        EXPECT_THROW(ParseDisplay(text), Error) << text;
}

// 250 lux on a screen that reflects 0.5 % are 0.398 cd/m2.
TEST(DisplayedLight, IsTheDisplaysAndTheRooms) {
    constexpr float inf = std::numeric_limits<float>::infinity();
    const std::vector<float> light = DisplayedLight(
        std::vector<float>{0, 0.5f, 1, 7, inf, -1, -inf, std::numeric_limits<float>::quiet_NaN()},
        ParseDisplay("200cd,250lux"));
    const float black = 0.2f + 0.39789f;
    const float expected[] = {
        black, 0.5f * 199.8f + black, 200.39789f, 200.39789f, 200.39789f, black, black, black};
    for (size_t i = 0; i < light.size(); ++i) EXPECT_NEAR(light[i], expected[i], 1e-4) << i;
}

}  // namespace
}  // namespace lull::display_test
