// Which group a light is in, by its names.
#include "renderer/scene/light_groups.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "tests/renderer/scene_of.h"

namespace lull::light_groups_test {
namespace {

constexpr const char* kLamps = R"(
LightSource "infinite" "rgb L" [1 1 1]
LightSource "point" "string lightgroup" "candle"
LightSource "distant"
MakeNamedMaterial "bulb" "string type" "matte"
AttributeBegin
  AreaLightSource "diffuse" "rgb L" [1 1 1]
  NamedMaterial "bulb"
  Shape "trianglemesh" "integer indices" [0 1 2 0 2 3] "point P" [0 0 0 1 0 0 1 1 0 0 1 0]
  AreaLightSource "diffuse" "rgb L" [1 1 1] "string lightgroup" "candle"
  Shape "sphere"
AttributeEnd
AttributeBegin
  AreaLightSource "diffuse" "rgb L" [1 1 1]
  Shape "disk"
AttributeEnd
)";

struct Lamps {
    Warnings warnings;
    Description description;
    std::unique_ptr<const Scene> scene;

    explicit Lamps(const std::string& world = kLamps) {
        description =
            ParsePbrt(TemporaryDirectory().Write("test.pbrt", WorldText(world)), warnings);
        CompileOptions options;
        options.threads = 1;
        scene = Compile(description, options, warnings);
    }
    LightGroups Group(const std::vector<std::string>& names) const {
        return MakeLightGroups(names, description, *scene);
    }
    // Returns the groups' names, and for each light the number of its.
    std::string Grouped(const std::vector<std::string>& names) const {
        const LightGroups groups = Group(names);
        std::string text = NameOf(groups) + ":";
        for (const int group : groups.ofLight) text += fmt::format(" {}", group);
        return text;
    }
    std::string ErrorOf(const std::vector<std::string>& names) const {
        return lull::ErrorOf([&] { Group(names); });
    }
};

// The sky, a point, a distant light, two triangles, a sphere and a disk.
TEST(LightGroups, AreNamedByTheScene) {
    const Lamps lamps;
    EXPECT_EQ(lamps.warnings.Counts().size(), 0u);  // of "lightgroup"
    EXPECT_EQ(lamps.Grouped({"candle"}), "candle,rest: 1 0 1 1 1 0 1");
    EXPECT_EQ(lamps.Grouped({"bulb", "candle"}), "bulb,candle,rest: 2 1 2 0 0 1 2");
    EXPECT_EQ(lamps.Grouped({"environment", "delta", "area"}),
              "environment,delta,area: 0 1 1 2 2 2 2");
    EXPECT_EQ(lamps.Grouped({"candle", "candle"}), "candle,rest: 1 0 1 1 1 0 1");
}

TEST(LightGroups, PreferTheMoreSpecificName) {
    const Lamps lamps;
    EXPECT_EQ(lamps.Grouped({"area", "bulb", "candle"}), "area,bulb,candle,rest: 3 2 3 1 1 2 0");
}

TEST(LightGroups, AreOneForEachName) {
    EXPECT_EQ(Lamps().Grouped({"each"}), "environment,candle,delta,bulb,area: 0 1 2 3 3 1 4");
    EXPECT_EQ(Lamps("Shape \"sphere\"").Grouped({"each"}), "rest:");
}

TEST(LightGroups, DifferInTextByTheirLights) {
    const Lamps lamps;
    const LightGroups some = lamps.Group({"candle"});
    LightGroups others = some;
    EXPECT_EQ(TextOf(others), TextOf(some));
    others.ofLight[0] = 0;
    EXPECT_NE(TextOf(others), TextOf(some));
}

TEST(LightGroups, ThatThereAreNotAreRefused) {
    const Lamps lamps;
    EXPECT_EQ(
        lamps.ErrorOf({"area", "lamp\n"}),
        "light group \"lamp\\x0a\": no light, object or material of a light has this name; there "
        "are: environment, candle, delta, bulb, area");
    EXPECT_TRUE(
        lamps.ErrorOf({"rest"}).starts_with("light group \"rest\": the layer of all other"));
    EXPECT_TRUE(Lamps("Shape \"sphere\"")
                    .ErrorOf({"area"})
                    .ends_with("the scene has no lights; leave the groups out"));
}

std::string Candles(int count) {
    std::string world;
    for (int i = 0; i < count; ++i)
        world += fmt::format("LightSource \"point\" \"string lightgroup\" \"lamp{}\"\n", i);
    return world;
}

TEST(LightGroups, ListTenNamesAndAreAtMostSixteen) {
    const Lamps many(Candles(17)), most(Candles(16));
    EXPECT_TRUE(many.ErrorOf({"x"}).ends_with("lamp7, lamp8, and 8 more")) << many.ErrorOf({"x"});
    EXPECT_TRUE(many.ErrorOf({"each"}).starts_with("17 light groups are more than the 16"));
    EXPECT_EQ(most.Group({"each"}).Count(), 16);
}

}  // namespace
}  // namespace lull::light_groups_test
