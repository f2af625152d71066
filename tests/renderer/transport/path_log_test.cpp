// Compares the paths that are told about with those that are rendered.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "renderer/transport/path_log.h"
#include "tests/renderer/scene_of.h"

namespace lull::path_log_test {
namespace {

constexpr const char* kGlass =
    "Integrator \"path\" \"integer maxdepth\" [7]\nCamera \"perspective\" \"float fov\" [40]\n"
    "WorldBegin\nLightSource \"infinite\" \"rgb L\" [.2 .3 .4]\n"
    "AttributeBegin AreaLightSource \"diffuse\" \"rgb L\" [9 8 7] Translate 0 2.5 0\n"
    "Shape \"sphere\" \"float radius\" [.4] AttributeEnd\n"
    "Material \"glass\" Shape \"sphere\" \"float radius\" [.7]\n"
    "Material \"matte\" Translate 0 -1 0 Rotate 90 1 0 0 Shape \"disk\" \"float radius\" [9]\n"
    "WorldEnd\n";
constexpr const char* kFog =
    "Integrator \"volpath\" \"integer maxdepth\" [9]\n"
    "MakeNamedMedium \"fog\" \"string type\" \"homogeneous\" \"rgb sigma_s\" [.5 .5 .5]\n"
    "Camera \"perspective\" \"float fov\" [40]\nWorldBegin\n"
    "LightSource \"point\" \"rgb I\" [5 5 5] \"point from\" [0 3 0]\n"
    "AttributeBegin Material \"\" MediumInterface \"fog\" \"\"\n"
    "Shape \"sphere\" \"float radius\" [1.5] AttributeEnd\n"
    "Material \"matte\" Shape \"sphere\" \"float radius\" [.5]\nWorldEnd\n";

std::unique_ptr<const Scene> MakeScene(const std::string& text) {
    return SceneOf(
        "LookAt 0 0 -5  0 0 0  0 1 0\n"
        "Film \"image\" \"integer xresolution\" [8] \"integer yresolution\" [8]\n" +
        text);
}

TEST(PathLog, IsOfTheSampleThatIsRendered) {
    for (const char* text : {kGlass, kFog})
        for (const Estimator estimator : {Estimator::Combined, Estimator::PbrtV3}) {
            const auto scene = MakeScene(text);
            Sampler sampler(SamplerKind::Sobol, 3);
            size_t steps = 0;
            for (int i = 0; i < 640; ++i) {
                const Vec2i pixel(i % 8, i / 8 % 8);
                const auto index = uint32_t(i / 64);
                const PathSample rendered = RenderSample(*scene, estimator, sampler, pixel, index);
                const PathLog log = LogSample(*scene, estimator, sampler, pixel, index);
                ASSERT_TRUE((log.sample.radiance == rendered.radiance).all()) << i;
                // The steps add up to it, and each starts where the one before ended.
                Rgb sum = Rgb::Zero();
                Vec3f from = log.ray.o, direction = log.ray.d.normalized();
                for (const PathStep& step : log.steps) {
                    sum += step.emitted + step.direct;
                    if (step.kind != PathStep::Kind::Sky) {
                        ASSERT_LT((from + step.distance * direction - step.position).norm(), 1e-2f);
                    }
                    from = step.position;
                    direction = step.direction;
                }
                sum *= log.filterWeight * log.cameraWeight * log.filmScale;
                ASSERT_LT((sum - rendered.radiance).abs().maxCoeff(),
                          1e-4f * (1 + rendered.radiance.maxCoeff()));
                steps += log.steps.size();
            }
            EXPECT_GT(steps, 640u);
        }
}

TEST(PathLog, TellsWhereLightComesFrom) {
    const auto scene = MakeScene(kGlass);
    Sampler sampler(SamplerKind::Random, 1);
    // The middle of the picture: into the glass ball and out of it, or off it.
    const PathLog log = LogSample(*scene, Estimator::Combined, sampler, {4, 4}, 0);
    ASSERT_GE(log.steps.size(), 2u);
    const PathStep& first = log.steps[0];
    EXPECT_EQ(first.kind, PathStep::Kind::Surface);
    EXPECT_EQ(first.object, 2u);
    EXPECT_NEAR(first.distance, 4.4f, 0.2f);  // not quite in the middle
    EXPECT_TRUE(first.goesOn);
    EXPECT_TRUE(first.isSpecular);
    EXPECT_TRUE(IsBlack(first.direct));
    EXPECT_TRUE((first.throughput == 1).all());
}

}  // namespace
}  // namespace lull::path_log_test
