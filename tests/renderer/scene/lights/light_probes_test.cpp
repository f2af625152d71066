#include "renderer/scene/lights/light_distribution.h"

#include <gtest/gtest.h>

#include "renderer/base/math.h"
#include "tests/renderer/scene_of.h"

namespace lull {
namespace {

// Returns what Contribution() does, by samples.
double BySamples(const Scene& scene, int light, const LightProbes& probes,
                 const LightProbes::Places& places) {
    double sum = 0;
    for (int k = 0; k < LightProbes::kCount; ++k) {
        const Vec3f p(places(k, 0), places(k, 1), places(k, 2));
        if (const auto sample = scene.lights.Sample(light, p, probes.u[size_t(k)]))
            sum += Luminance(scene.lights.Radiance(light, *sample)) / sample->pdf;
    }
    return sum;
}

TEST(LightProbes, KnowWhatSamplesBring) {
    const std::string emitting = "AreaLightSource \"diffuse\" \"rgb L\" [3 2 1] ";
    const std::string twoSided = emitting + "\"bool twosided\" \"true\" ";
    const std::string triangle =
        "Shape \"trianglemesh\" \"integer indices\" [0 1 2] \"point P\" [-1 -1 0  1 -1 0  0 1 .5]";
    const std::string sphere = "Shape \"sphere\" \"float radius\" [.7]";
    const std::string worlds[] = {
        emitting + triangle,
        twoSided + triangle,
        emitting + sphere,
        emitting + "ReverseOrientation " + sphere,
        twoSided + "ReverseOrientation " + sphere,
        emitting + "Shape \"disk\" \"float radius\" [.7]",
        "LightSource \"point\" \"rgb I\" [1 2 3]",
        "LightSource \"infinite\" \"rgb L\" [1 2 3]",
    };
    const LightProbes probes;
    for (const std::string& world : worlds) {
        const auto scene =
            SceneOf(WorldText("AttributeBegin\nScale 2 2 2\n" + world + "\nAttributeEnd\n"));
        ASSERT_EQ(scene->lights.Count(), 1) << world;
        // Before and behind it, around it, and where it lies in the voxel.
        for (const Bounds3f& voxel :
             {Bounds3f{{2, 1, 3}, {3, 2, 5}}, Bounds3f{{-2, 1, -5}, {0, 2, -3}},
              Bounds3f{{-.2f, -.2f, -.2f}, {.2f, .2f, .2f}}, Bounds3f{{-3, -3, -3}, {3, 3, 3}}}) {
            const LightProbes::Places places = probes.PlacesIn(voxel);
            const double expected = BySamples(*scene, 0, probes, places);
            EXPECT_NEAR(Contribution(scene->lights[0], probes, places), expected, 2e-4 * expected)
                << world << voxel.lower.transpose();
        }
    }
}

}  // namespace
}  // namespace lull
