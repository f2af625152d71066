#include "renderer/scene/lights/emission_profile.h"

#include <gtest/gtest.h>

#include <numbers>

#include "tests/renderer/scene_of.h"

namespace lull::emission_profile_test {
namespace {

double FalloffAt(const Spread& spread, double theta) {
    const Vec3f w(float(std::sin(theta)), 0, float(std::cos(theta)));
    return double(Falloff(spread, Vec3f::UnitZ(), w));
}

TEST(EmissionProfile, KeepsThePower) {
    for (const double degrees : {1., 20., 90., 150., 179., 180.}) {
        const Spread spread = Spread::Make(degrees);
        const double half = degrees * std::numbers::pi / 360;
        constexpr int kSteps = 20000;
        double power = 0;  // of radiance 1
        for (int i = 0; i < kSteps; ++i) {
            const double theta = (i + 0.5) * half / kSteps;
            power += FalloffAt(spread, theta) * std::cos(theta) * std::sin(theta) * 2 *
                     std::numbers::pi * half / kSteps;
        }
        EXPECT_NEAR(power, std::numbers::pi, 2e-3) << degrees;
        if (degrees < 180) {
            EXPECT_EQ(FalloffAt(spread, 1.01 * half), 0) << degrees;
        }
        EXPECT_EQ(PowerFraction(spread), 1);
    }
}

// Worked out for 90 degrees across: (1 - tan theta) / (1 - pi / 4).
TEST(EmissionProfile, FallsByTheTangent) {
    const Spread spread = Spread::Make(90);
    EXPECT_NEAR(FalloffAt(spread, 0), 4.65979, 1e-4);
    EXPECT_NEAR(FalloffAt(spread, std::atan(0.25)), 0.75 * 4.65979, 1e-4);
    EXPECT_NEAR(Falloff(spread, -Vec3f::UnitZ(), Vec3f::UnitZ()), 4.65979f, 1e-4f);
    EXPECT_EQ(Falloff(spread, Vec3f::UnitZ(), Vec3f::UnitX()), 0);
}

// Down to the least there are numbers alone.
TEST(EmissionProfile, IsFiniteHoweverNarrow) {
    for (const double degrees : {1e-30, 1e-3, 0.1}) {
        const double falloff = FalloffAt(Spread::Make(degrees), 0);
        EXPECT_TRUE(std::isfinite(falloff) && falloff > 0) << degrees;
    }
}

TEST(EmissionProfile, RefusesOtherAngles) {
    for (const char* bad : {"0", "-1", "181"}) {
        try {
            SceneOf(WorldText(std::string("AreaLightSource \"diffuse\" \"float spread\" [") + bad +
                              "]\nShape \"sphere\"\n"));
            ADD_FAILURE() << bad;
        } catch (const Error& error) {
            EXPECT_NE(std::string(error.what()).find("above 0 and at most 180 degrees"),
                      std::string::npos)
                << error.what();
        }
    }
}

}  // namespace
}  // namespace lull::emission_profile_test
