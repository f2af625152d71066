// Numbers that have to be at least 0 are 0 where an exporter's rounding has left them just below.
#include "renderer/input/spectrum.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "tests/renderer/files/test_files.h"
#include "tests/renderer/scene_of.h"

namespace lull::rounded_zeros_test {
namespace {

struct Place {
    const char *options, *world;  // with {} in place of the number
};

constexpr const char* kMedium =
    "MakeNamedMedium \"m\" \"string type\" \"{}\" {}\nMediumInterface \"m\" \"\"\n"
    "Shape \"sphere\"\n";

std::string Homogeneous(const std::string& parameters) {
    return fmt::format(fmt::runtime(kMedium), "homogeneous", parameters);
}

std::string ErrorWith(const Place& place, const char* number) {
    const auto filled = [&](const char* text) { return fmt::format(fmt::runtime(text), number); };
    return ErrorOf([&] { SceneOf(WorldText(filled(place.world), filled(place.options))); });
}

TEST(RoundedZeros, AreZeroInScenes) {
    const std::string absorption = Homogeneous("\"rgb sigma_a\" [1 {0} 1]"),
                      scattering = Homogeneous("\"rgb sigma_s\" [1 {0} 1]"),
                      scale = Homogeneous("\"float scale\" [{0}]"),
                      density = fmt::format(fmt::runtime(kMedium), "heterogeneous",
                                            "\"integer nx\" [2] \"float density\" [1 {0}] "
                                            "\"rgb sigma_a\" [1 1 1] \"rgb sigma_s\" [1 1 1]");
    const Place places[] = {
        {"\nCamera \"perspective\" \"float lensradius\" [{}]", "Shape \"sphere\""},
        {"\nCamera \"perspective\" \"float clipstart\" [{}]", "Shape \"sphere\""},
        {"", "Shape \"disk\" \"float innerradius\" [{}]"},
        {"", "Shape \"curve\" \"point P\" [0 0 0 1 0 0 2 0 0 3 0 0] \"float width0\" [{}]"},
        {"", "Material \"subsurface\" \"float scale\" [{}]\nShape \"sphere\""},
        {"Integrator \"volpath\"", absorption.c_str()},
        {"Integrator \"volpath\"", scattering.c_str()},
        {"Integrator \"volpath\"", scale.c_str()},
        {"Integrator \"volpath\"", density.c_str()},
    };
    for (const Place& place : places) {
        EXPECT_EQ(ErrorWith(place, "-1e-9"), "") << place.options << place.world;
        EXPECT_EQ(ErrorWith(place, "-0"), "") << place.options << place.world;
        EXPECT_TRUE(Contains(ErrorWith(place, "-0.1"), "test.pbrt:"))
            << place.options << place.world;
    }
}

// Only 0 is cut out, and so is what rounding makes of it.
TEST(RoundedZeros, OfAlphaAreCutOut) {
    const auto isHit = [](const char* alpha) {
        const auto scene = SceneOf(WorldText(fmt::format(
            "Shape \"trianglemesh\" \"integer indices\" [0 1 2] \"point P\" [-1 -1 1 1 -1 1 0 2 1] "
            "\"float alpha\" {}",
            alpha)));
        return scene->shapes.shapes.at(0).alpha.has_value();
    };
    EXPECT_TRUE(isHit("0"));
    EXPECT_TRUE(isHit("-1e-8"));
    EXPECT_FALSE(isHit("0.5"));
    EXPECT_FALSE(isHit("-0.5"));
}

TEST(RoundedZeros, AreZeroAsParameters) {
    EXPECT_EQ(RaisedToZero(-1e-9f), 0);
    EXPECT_EQ(RaisedToZero(-0.1f), -0.1f);
    EXPECT_EQ(RaisedToZero(0.1f), 0.1f);
    Entity entity;
    EXPECT_EQ(GetNonnegative(entity, "width", 0.5f), 0.5f);
}

TEST(RoundedLimits, OfSubsurfaceScatteringAreTheirLimits) {
    for (const char* value : {"0.999999", "1", "4.00001"})
        EXPECT_EQ(
            ErrorWith({"", "Material \"subsurface\" \"float eta\" [{}]\nShape \"sphere\""}, value),
            "")
            << value;
    EXPECT_TRUE(Contains(
        ErrorWith({"", "Material \"subsurface\" \"float eta\" [{}]\nShape \"sphere\""}, "0.99"),
        "has to lie between 1 and 4"));
}

}  // namespace
}  // namespace lull::rounded_zeros_test
