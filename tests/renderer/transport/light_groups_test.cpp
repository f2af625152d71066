// The light of groups: it adds up to that of the sample, and each part is that of its lights alone.
#include "renderer/scene/light_groups.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "renderer/transport/integrator.h"
#include "tests/renderer/scene_of.h"
#include "tests/renderer/transport/pixel_statistics.h"

namespace lull::light_groups_test {
namespace {

// Which lights of the scenes below shine; all are there all the same.
struct Lit {
    bool sky = true, lamp = true, point = true;
};

// A room that is open to the sky, with a lamp and a point light, and things in it.
std::string RoomText(const std::string& things, const Lit& lit, const std::string& integrator) {
    const auto scale = [](bool isLit) { return isLit ? "1 1 1" : "0 0 0"; };
    return fmt::format(
        R"(LookAt 0 0 -3  0 0 0  0 1 0
Camera "perspective" "float fov" 45
Film "image" "integer xresolution" 8 "integer yresolution" 8
PixelFilter "mitchell"
Integrator "{}" "integer maxdepth" 6
WorldBegin
LightSource "infinite" "rgb L" [.4 .5 .7] "rgb scale" [{}]
LightSource "point" "point from" [-.5 .3 -.8] "rgb I" [.5 .2 .1] "rgb scale" [{}]
AttributeBegin
  AreaLightSource "diffuse" "rgb L" [6 5 4] "rgb scale" [{}]
  Translate .4 .6 0  Rotate 90 1 0 0
  Shape "disk" "float radius" .3
AttributeEnd
Material "matte" "rgb Kd" [.7 .5 .3]
Shape "trianglemesh" "integer indices" [0 1 2 0 2 3 4 5 6 4 6 7]
  "point P" [-1 -1 -1  1 -1 -1  1 -1 1  -1 -1 1   -1 -1 1  1 -1 1  1 1 1  -1 1 1]
{}
WorldEnd
)",
        integrator, scale(lit.sky), scale(lit.point), scale(lit.lamp), things);
}

constexpr const char* kBalls = R"(
AttributeBegin
  Translate -.4 -.6 0
  Material "glass"
  Shape "sphere" "float radius" .4
  Translate .8 0 0
  Material "plastic" "float roughness" .05
  Shape "sphere" "float radius" .4
AttributeEnd
)";
constexpr const char* kSkin = R"(
AttributeBegin
  Translate 0 -.5 0
  Material "kdsubsurface" "rgb Kd" [.7 .6 .6] "rgb mfp" [.2 .1 .1]
  Shape "sphere" "float radius" .5
AttributeEnd
)";
constexpr const char* kFog = R"(
MakeNamedMedium "m" "string type" "homogeneous" "rgb sigma_a" [.1 .1 .1] "rgb sigma_s" [1 2 3]
AttributeBegin
  Translate 0 -.3 0
  Material "none"
  MediumInterface "m" ""
  Shape "sphere" "float radius" .7
AttributeEnd
)";

struct Room {
    const char* things;
    const char* integrator;
};
constexpr Room kRooms[] = {{kBalls, "path"}, {kSkin, "path"}, {kFog, "volpath"}};

// A scene, and its lights in three groups: environment, delta, area.
struct GroupedScene {
    Description description;
    std::unique_ptr<const Scene> scene;
    LightGroups groups;

    explicit GroupedScene(const std::string& text) {
        Warnings warnings;
        description = ParsePbrt(TemporaryDirectory().Write("test.pbrt", text), warnings);
        CompileOptions options;
        options.threads = 1;
        scene = Compile(description, options, warnings);
        groups = MakeLightGroups({"environment", "delta", "area"}, description, *scene);
    }
};

// 100 samples of each pixel; the paths of samples with groups are those without, but for last bits,
// as compilers fuse multiplications and additions of the integrator's two instances differently.
TEST(GroupRadiance, AddsUpToThatOfTheSample) {
    for (const Room& room : kRooms)
        for (const Estimator estimator : kEstimators) {
            const GroupedScene grouped(RoomText(room.things, {}, room.integrator));
            ASSERT_EQ(grouped.groups.Count(), 3);
            Sampler a(SamplerKind::Sobol, 3), b = a;
            GroupRadiance groups(grouped.groups);
            std::array<double, 3> found = {};
            for (int i = 0; i < 6400; ++i) {
                const Vec2i pixel(i % 8, i / 8 % 8);
                const Rgb whole =
                    RenderSample(*grouped.scene, estimator, a, pixel, uint32_t(i / 64)).radiance;
                PathSample with{.groups = &groups};
                RenderSample(*grouped.scene, estimator, b, pixel, uint32_t(i / 64), &with);
                Rgb sum = Rgb::Zero();
                for (size_t g = 0; g < 3; ++g) {
                    sum += groups.All()[g];
                    found[g] += double(groups.All()[g].sum());
                }
                for (int c = 0; c < 3; ++c) {
                    ASSERT_FLOAT_EQ(with.radiance[c], whole[c]);
                    ASSERT_NEAR(sum[c], whole[c], 1e-5f * std::abs(whole[c])) << room.things;
                }
            }
            for (const double light : found) EXPECT_GT(light, 10) << room.things;
        }
}

// Returns the means of a function of samples over all pixels.
template <typename Take>
ImageMean MeansOf(const Take& take) {
    constexpr int kSamples = 64 * 600;
    Eigen::Array3d sum = Eigen::Array3d::Zero(), squares = sum;
    Sampler sampler(SamplerKind::Random, 7);
    for (int i = 0; i < kSamples; ++i) {
        const Eigen::Array3d values = take(sampler, Vec2i(i % 8, i / 8 % 8), uint32_t(i / 64));
        sum += values;
        squares += values.square();
    }
    const Eigen::Array3d mean = sum / kSamples;
    return {mean, ((squares / kSamples - mean.square()) / kSamples).sqrt()};
}

TEST(GroupRadiance, IsThatOfTheSceneWithItsLightsAlone) {
    for (const Room& room : kRooms)
        for (const Estimator estimator : kEstimators) {
            const GroupedScene all(RoomText(room.things, {}, room.integrator));
            const Lit alone[] = {{true, false, false}, {false, false, true}, {false, true, false}};
            GroupRadiance groups(all.groups);
            const ImageMean ofGroups = MeansOf([&](Sampler& sampler, const Vec2i& p, uint32_t k) {
                PathSample sample{.groups = &groups};
                RenderSample(*all.scene, estimator, sampler, p, k, &sample);
                const auto of = [&](size_t g) { return double(Luminance(groups.All()[g])); };
                return Eigen::Array3d(of(0), of(1), of(2));
            });
            for (int g = 0; g < 3; ++g) {
                const GroupedScene one(RoomText(room.things, alone[g], room.integrator));
                const ImageMean own = MeansOf([&](Sampler& sampler, const Vec2i& p, uint32_t k) {
                    const Rgb L = RenderSample(*one.scene, estimator, sampler, p, k).radiance;
                    return Eigen::Array3d::Constant(double(Luminance(L)));
                });
                EXPECT_GT(own.mean[g], 0);
                EXPECT_NEAR(ofGroups.mean[g], own.mean[g],
                            4.5 * std::hypot(ofGroups.error[g], own.error[g]))
                    << room.integrator << " " << g;
            }
        }
}

// Visits samples of balls on a film with one more parameter.
template <typename Visit>
void VisitSamples(const std::string& parameter, const Visit& visit) {
    std::string text = RoomText(kBalls, {}, "path");
    text.replace(text.find("Film \"image\""), 12, "Film \"image\" " + parameter);
    const GroupedScene grouped(text);
    GroupRadiance groups(grouped.groups);
    Sampler sampler(SamplerKind::Sobol, 3);
    PathSample sample{.groups = &groups};
    for (int i = 0; i < 640; ++i) {
        RenderSample(*grouped.scene, Estimator::Combined, sampler, Vec2i(i % 8, i / 8 % 8),
                     uint32_t(i / 64), &sample);
        visit(sample, groups.All());
    }
}

TEST(GroupRadiance, IsLimitedAsTheSample) {
    float most = 0;
    VisitSamples("\"float maxsampleluminance\" .3", [&](const PathSample& sample, auto groups) {
        const Rgb& whole = sample.radiance;
        Rgb sum = Rgb::Zero();
        for (const Rgb& radiance : groups) sum += radiance;
        for (int c = 0; c < 3; ++c) ASSERT_NEAR(sum[c], whole[c], 1e-5f * std::abs(whole[c]));
        most = std::max(most, Luminance(whole));
    });
    EXPECT_LT(most, 0.6f);  // the filter's weight is above 1 in places
}

// The film's scale makes every sample infinite.
TEST(GroupRadiance, OfRejectedSamplesIsBlack) {
    int rejected = 0;
    VisitSamples("\"float scale\" 3e38", [&](const PathSample& sample, auto groups) {
        rejected += sample.rejected;
        for (const Rgb& radiance : groups) {
            ASSERT_TRUE(IsFinite(radiance));
            ASSERT_TRUE(!sample.rejected || IsBlack(radiance));
        }
    });
    EXPECT_GT(rejected, 100);
}

}  // namespace
}  // namespace lull::light_groups_test
