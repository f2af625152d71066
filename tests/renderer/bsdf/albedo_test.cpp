#include "renderer/bsdf/albedo.h"

#include <gtest/gtest.h>

#include "renderer/base/color.h"
#include "tests/renderer/bsdf/lobe_examples.h"

namespace lull::test {
namespace {

const Frame kFrame{Vec3f::UnitX(), Vec3f::UnitY(), Vec3f::UnitZ()};

Bsdf Of(std::initializer_list<Lobe> lobes) {
    Bsdf bsdf(kFrame, Vec3f::UnitZ());
    for (const Lobe& lobe : lobes) bsdf.Add(lobe);
    return bsdf;
}

Vec3f Direction(float cosine) { return {SafeSqrt(1 - cosine * cosine), 0, cosine}; }

// Is the estimate by which lobes are chosen, before its luminance is taken.
TEST(AlbedoOf, IsWhatLobesAreChosenBy) {
    for (const NamedLobe& example : SpreadLobes())
        for (const float cosine : {1.f, 0.4f, -0.7f}) {
            const Rgb albedo = AlbedoOf(Of({example.lobe}), Direction(cosine));
            const float estimated = EstimatedAlbedo(example.lobe, Direction(cosine));
            EXPECT_GE(albedo.minCoeff(), 0) << example.name;
            EXPECT_LE(albedo.maxCoeff(), 1) << example.name;
            EXPECT_LE(Luminance(albedo), estimated + 1e-5f) << example.name;
            if (albedo.maxCoeff() < 1) {
                EXPECT_NEAR(Luminance(albedo), estimated, 1e-5f) << example.name;
            }
        }
}

TEST(AlbedoOf, IsTheColourOfSimpleSurfaces) {
    const Rgb color(0.9f, 0.5f, 0.2f), glass(1, 1, 1);
    for (const float cosine : {1.f, 0.3f, -0.3f}) {
        const Vec3f wo = Direction(cosine);
        EXPECT_TRUE(AlbedoOf(Of({LambertianReflection{color}}), wo).isApprox(color, 1e-5f));
        EXPECT_TRUE(AlbedoOf(Of({FresnelSpecular{glass, glass, 1.5f}}), wo).isApprox(glass));
        // Two lobes together, and never more than all light.
        const Bsdf both = Of({LambertianReflection{color}, LambertianTransmission{color}});
        EXPECT_TRUE(AlbedoOf(both, wo).isApprox(Rgb(1, 1, 0.4f), 1e-5f));
    }
    EXPECT_TRUE(AlbedoOf(Of({LambertianReflection{color}}), Vec3f::UnitX()).isZero());
    EXPECT_TRUE(AlbedoOf(Of({}), Vec3f::UnitZ()).isZero());
}

TEST(AlbedoOf, IsFiniteWhereColoursAreNot) {
    const float nan = std::numeric_limits<float>::quiet_NaN();
    const Rgb albedo =
        AlbedoOf(Of({LambertianReflection{Rgb(nan, -1, kInfinity)}}), Vec3f::UnitZ());
    EXPECT_EQ(albedo.x(), 0);
    EXPECT_EQ(albedo.y(), 0);
    EXPECT_EQ(albedo.z(), 1);
}

}  // namespace
}  // namespace lull::test
