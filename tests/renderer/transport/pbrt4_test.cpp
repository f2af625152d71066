// Renders scenes for pbrt-v4 whose values are known, and checks coats by themselves.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

#include "renderer/bsdf/bsdf.h"
#include "tests/renderer/scene_of.h"
#include "tests/renderer/transport/pixel_statistics.h"
#include "tests/shared_folder.h"

namespace lull {
namespace {

TEST(Pbrt4Features, HaveTheirValues) {
    LULL_SHARED_FILE(root, "pbrt4-scenes/features");
    std::ifstream table(root / "EXPECTED.csv");
    int rows = 0;
    for (std::string line; std::getline(table, line);) {
        if (line.starts_with("#") || line.starts_with("file,")) continue;
        ++rows;
        std::stringstream in(line);
        std::string file;
        std::getline(in, file, ',');
        Eigen::Array3d rgb;
        double tolerance;
        char comma;
        in >> rgb[0] >> comma >> rgb[1] >> comma >> rgb[2] >> comma >> tolerance;
        const auto scene = SceneIn((root / file).string());
        const auto pixels = MeasurePixels(*scene, Estimator::Combined, SamplerKind::Random, 256, 1);
        EXPECT_EQ(pixels.rejected, 0) << file;
        auto [mean, error] = MeanOf(pixels);
        mean *= double(scene->film.scale);
        const bool isRelative = file == "spot-falloff.pbrt";
        for (int c = 0; c < 3; ++c)
            EXPECT_NEAR(mean[c], rgb[c], tolerance * (isRelative ? rgb[c] : 1) + 4 * error[c])
                << file;
    }
    EXPECT_EQ(rows, 46);
}

TEST(Pbrt4, SkyWithFogWarnsOfNothing) {
    const auto warnings = WarningsOf(
        "Film \"rgb\"\nMakeNamedMedium \"fog\" \"string type\" \"homogeneous\"\nWorldBegin\n"
        "LightSource \"infinite\"\nMediumInterface \"fog\" \"\"\nMaterial \"interface\"\n"
        "Shape \"sphere\"");
    EXPECT_TRUE(warnings.empty());
}

// Directional albedos of pbrt-v4's random walk, which these functions were derived from.
TEST(Coat, AlbedoIsThatOfTheWalk) {
    struct Case {
        float alpha, rho, cosine, top, below;
    };
    constexpr Case kCases[] = {
        {0, .5f, 1, .040f, .264f},      {0, .5f, .5f, .089f, .250f}, {0, 1, 1, .040f, .825f},
        {0, 1, .2f, .339f, .567f},      {.1f, .5f, 1, .040f, .260f}, {.1f, 1, .5f, .086f, .737f},
        {.25f, .5f, .2f, .134f, .196f}, {.25f, 1, 1, .037f, .661f},  {.25f, 1, .2f, .134f, .536f},
        {.5f, .5f, 1, .028f, .210f},    {.5f, 1, .5f, .044f, .453f}, {.5f, 1, .2f, .078f, .402f},
    };
    for (const Case& c : kCases) {
        const CoatTable table(c.alpha, 1.5f, .01f);
        float blend;
        const CoatedDiffuseLobe lobe{Rgb::Constant(c.rho).eval(), TrowbridgeReitz(c.alpha, c.alpha),
                                     table.RowOf(c.alpha, &blend), blend};
        const Vec3f wo(std::sqrt(1 - c.cosine * c.cosine), 0, c.cosine);
        EXPECT_NEAR(lobe.BaseAlbedo(c.cosine).x(), c.below, .006f) << c.alpha << " " << c.cosine;
        double sum = 0;
        constexpr int kSteps = 256;
        for (int i = 0; i < kSteps; ++i)
            for (int j = 0; j < kSteps; ++j) {
                Vec3f wi;
                const Vec2f u((float(i) + .5f) / kSteps, (float(j) + .5f) / kSteps);
                if (!lobe.Sample(wo, u, &wi)) continue;
                const BsdfValue v = lobe.Evaluate(wo, wi);
                if (v.pdf > 0) sum += double(v.f.x() * wi.z() / v.pdf);
            }
        const double top = c.alpha > 0 ? double(c.top) : 0;  // a smooth one is another lobe
        EXPECT_NEAR(sum / (kSteps * kSteps), top + double(c.below), .01) << c.alpha << " " << c.rho;
    }
}

TEST(Coat, IsReciprocal) {
    const CoatTable table(.2f, 1.5f, .01f), varying(1.7f, .02f);
    for (const float alpha : {.2f, .37f}) {
        float blend;
        const CoatTable& used = alpha == .2f ? table : varying;
        const CoatedDiffuseLobe lobe{Rgb(.2f, .5f, .9f), TrowbridgeReitz(alpha, alpha),
                                     used.RowOf(alpha, &blend), blend};
        const Vec3f a = Vec3f(.3f, .1f, .9f).normalized(), b = Vec3f(-.8f, .5f, .2f).normalized();
        const Rgb ab = lobe.Evaluate(a, b).f, ba = lobe.Evaluate(b, a).f;
        EXPECT_LT((ab - ba).abs().maxCoeff(), 1e-5f);
        EXPECT_GT(ab.minCoeff(), 0);
    }
}

// Gold under a coat, by the random walk with single scattering at each interface.
TEST(Coat, ConductorIsThatOfTheWalk) {
    struct Case {
        const char* parameters;
        double red, green, blue;
    };
    constexpr Case kCases[] = {
        {"\"float interface.roughness\" .02 \"float conductor.roughness\" .002", .9214, .6865,
         .2468},
        {"\"float conductor.roughness\" .01", .9213, .6827, .2443},
        {"\"float interface.roughness\" .01", .9496, .7097, .2548},
        {"\"float interface.roughness\" .1 \"float conductor.roughness\" .1", .5659, .4069, .1456},
    };
    for (const Case& c : kCases) {
        const auto scene = SceneOf(fmt::format(
            "Film \"rgb\" \"integer xresolution\" 8 \"integer yresolution\" 8\n"
            "Camera \"perspective\" \"float fov\" 2\nWorldBegin\nLightSource \"infinite\"\n"
            "Material \"coatedconductor\" \"spectrum conductor.eta\" \"metal-Au-eta\" "
            "\"spectrum conductor.k\" \"metal-Au-k\" {}\nShape \"trianglemesh\" "
            "\"integer indices\" [0 2 1 0 3 2] \"point3 P\" [-9 -9 5 9 -9 5 9 9 5 -9 9 5]",
            c.parameters));
        const auto pixels =
            MeasurePixels(*scene, Estimator::Combined, SamplerKind::Random, 1000, 1);
        const Eigen::Array3d mean = MeanOf(pixels).mean;
        for (const auto& [found, expected] :
             {std::pair(mean[0], c.red), {mean[1], c.green}, {mean[2], c.blue}})
            EXPECT_NEAR(found, expected, .01) << c.parameters;
    }
}

}  // namespace
}  // namespace lull
