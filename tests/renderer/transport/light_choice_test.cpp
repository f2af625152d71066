// Compares images whose lights are chosen in different ways: their means are the same.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "tests/renderer/scene_of.h"
#include "tests/renderer/transport/pixel_statistics.h"

namespace lull {
namespace {

// A room without walls that has everything that the choice of a light depends on: lamps of all
// shapes, on either side of surfaces, surfaces that let light through and that do not.
std::string World() {
    std::string world =
        "LightSource \"infinite\" \"rgb L\" [.1 .1 .2]\n"
        "LightSource \"distant\" \"rgb L\" [.3 .3 .2] \"point from\" [1 3 -1]\n"
        "Material \"matte\" \"rgb Kd\" [.6 .5 .4]\n"
        "Shape \"trianglemesh\" \"integer indices\" [0 1 2 0 2 3] "
        "\"point P\" [-3 -1 -3  3 -1 -3  3 -1 3  -3 -1 3]\n"
        "AttributeBegin\nMaterial \"translucent\"\nTranslate -.6 0 0\n"
        "Shape \"sphere\" \"float radius\" [.5]\nAttributeEnd\n"
        "AttributeBegin\nMaterial \"plastic\" \"float roughness\" [.05]\nTranslate .6 -.3 0\n"
        "Shape \"sphere\" \"float radius\" [.5]\nAttributeEnd\n";
    for (int i = 0; i < 30; ++i) {
        const double angle = 0.7 * i;
        world += fmt::format("AttributeBegin\nTranslate {} {} {}\nRotate {} 3 1 2\n",
                             2 * std::cos(angle), 0.07 * i - 1.2, 2 * std::sin(angle), 37 * i);
        if (i % 5 == 0) world += "LightSource \"point\" \"rgb I\" [.2 .1 .1]\n";
        if (i % 5 == 1) world += "LightSource \"spot\" \"rgb I\" [.5 .5 1]\n";
        if (i % 5 >= 2)
            world += fmt::format(
                "AreaLightSource \"diffuse\" \"rgb L\" [3 {} 2] \"bool twosided\" "
                "\"{}\"\n",
                i % 4, i % 2 ? "true" : "false");
        if (i % 5 == 2) world += "Shape \"disk\" \"float radius\" [.2]\n";
        if (i % 5 == 3) world += "Shape \"sphere\" \"float radius\" [.1]\n";
        if (i % 5 == 4)
            world +=
                "Shape \"trianglemesh\" \"integer indices\" [0 1 2 0 2 3] "
                "\"point P\" [0 0 0  .5 0 0  .5 .4 .1  0 .4 0]\n";
        world += "AttributeEnd\n";
    }
    return world;
}

ImageMean Measure(const char* strategy, bool lightsAsPbrtV3, Estimator estimator) {
    const std::string before = fmt::format(
        "LookAt 0 .7 -4  0 -.2 0  0 1 0\nCamera \"perspective\" \"float fov\" [45]\n"
        "Film \"image\" \"integer xresolution\" [16] \"integer yresolution\" [16]\n"
        "Integrator \"path\" \"string lightsamplestrategy\" \"{}\" \"integer maxdepth\" [3]",
        strategy);
    CompileOptions options;
    options.lightsAsPbrtV3 = lightsAsPbrtV3;
    const auto scene = SceneOf(WorldText(World(), before), options);
    const auto pixels = MeasurePixels(*scene, estimator, SamplerKind::Random, 256, 1);
    EXPECT_EQ(pixels.rejected, 0);
    return MeanOf(pixels);
}

TEST(LightChoice, LeavesTheMeanAsItIs) {
    const ImageMean power = Measure("power", false, Estimator::Combined);
    EXPECT_GT(power.mean.mean(), 0);
    const auto expectSame = [&](const ImageMean& other, const char* name) {
        // The channels are nearly fully correlated.
        const double error = std::sqrt((power.error.square() + other.error.square()).mean());
        EXPECT_NEAR(other.mean.mean(), power.mean.mean(), 4 * error) << name;
        EXPECT_LT(error, 0.02 * power.mean.mean()) << name;
    };
    expectSame(Measure("spatial", true, Estimator::Combined), "tables");
    expectSame(Measure("bvh", false, Estimator::Combined), "hierarchy");
    expectSame(Measure("bvh", false, Estimator::PbrtV3), "hierarchy, pbrt-v3");
}

}  // namespace
}  // namespace lull
