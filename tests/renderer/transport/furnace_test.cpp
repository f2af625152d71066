// Compares path tracing with scenes whose radiance is known, and its estimators with each other.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "renderer/bsdf/fresnel.h"
#include "tests/renderer/scene_of.h"
#include "tests/renderer/transport/pixel_statistics.h"

namespace lull::furnace_test {
namespace {

std::unique_ptr<const Scene> MakeScene(const std::string& world, const char* integrator = "",
                                       int size = 8, const char* camera = "0 0 -3  0 0 0  0 1 0",
                                       int fov = 40) {
    return SceneOf(WorldText(
        world,
        fmt::format("LookAt {}\nCamera \"perspective\" \"float fov\" [{}]\n"
                    "Film \"image\" \"integer xresolution\" [{}] \"integer yresolution\" [{}]\n"
                    "Integrator \"path\" {}",
                    camera, fov, size, size, integrator)));
}

// Averages over the whole image.
ImageMean Measure(const Scene& scene, Estimator estimator, int samples = 256, uint64_t seed = 1) {
    const auto pixels = MeasurePixels(scene, estimator, SamplerKind::Random, samples, seed);
    EXPECT_EQ(pixels.rejected, 0);
    return MeanOf(pixels);
}

const std::string kSky = "LightSource \"infinite\" \"rgb L\" [1 1 1]\n";
// A sphere that fills the image.
constexpr const char* kBall = "Shape \"sphere\" \"float radius\" [2]\n";
constexpr const char* kClose = "0 0 -2.5  0 0 0  0 1 0";

// Inside a closed sphere of albedo r that emits e, radiance is e / (1 - r) everywhere.
TEST(Furnace, ClosedDiffuseSphere) {
    for (const Estimator estimator : kEstimators)
        for (const double r : {0.0, 0.5, 0.8}) {
            const auto scene =
                MakeScene(fmt::format("Material \"matte\" \"rgb Kd\" [{0} {0} {0}]\n"
                                      "AreaLightSource \"diffuse\" \"rgb L\" [1 1 1]\n"
                                      "ReverseOrientation\nShape \"sphere\" \"float radius\" [2]",
                                      r),
                          "\"integer maxdepth\" [1000]", 8, "0.3 0.2 -1  0 0 0  0 1 0", 90);
            const ImageMean t = Measure(*scene, estimator, 200);
            EXPECT_NEAR(t.mean.y(), 1 / (1 - r), 4.5 * t.error.y() + 1e-4) << r;
        }
}

// With depth limited to k, the series stops after k reflections.
TEST(Furnace, DepthEndsTheSeries) {
    for (const Estimator estimator : kEstimators)
        for (const int depth : {0, 1, 2, 5, 9}) {
            const auto scene = MakeScene(
                "Material \"matte\" \"rgb Kd\" [.5 .5 .5]\n"
                "AreaLightSource \"diffuse\" \"rgb L\" [1 1 1]\n"
                "ReverseOrientation\nShape \"sphere\" \"float radius\" [2]",
                fmt::format("\"integer maxdepth\" [{}]", depth).c_str(), 8,
                "0.3 0.2 -1  0 0 0  0 1 0", 90);
            const ImageMean t = Measure(*scene, estimator, 200);
            EXPECT_NEAR(t.mean.y(), 2 - std::pow(0.5, depth), 4.5 * t.error.y() + 1e-4) << depth;
        }
}

TEST(Furnace, ConvexMatteBallShowsItsAlbedo) {
    for (const Estimator estimator : kEstimators)
        for (const double r : {0.25, 1.0}) {
            const auto scene = MakeScene(
                fmt::format("{0}Material \"matte\" \"rgb Kd\" [{1} {1} {1}]\n{2}", kSky, r, kBall),
                "", 8, kClose);
            const ImageMean t = Measure(*scene, estimator);
            EXPECT_NEAR(t.mean.y(), r, 4.5 * t.error.y() + 1e-4) << r;
        }
}

// Objects that neither absorb nor emit light cannot be seen in an even environment.
TEST(Furnace, LosslessSpecularBallsAreInvisible) {
    std::vector<std::string> materials = {"\"mirror\" \"rgb Kr\" [1 1 1]"};
    for (const double eta : {1.01, 1.33, 1.5, 2.4})
        materials.push_back(
            fmt::format("\"glass\" \"float eta\" [{}] \"rgb Kr\" [1 1 1] \"rgb Kt\" [1 1 1]", eta));
    for (const Estimator estimator : kEstimators)
        for (const std::string& material : materials) {
            const auto scene = MakeScene(kSky + "Material " + material + "\n" + kBall,
                                         "\"integer maxdepth\" [10000]", 8, kClose);
            const ImageMean t = Measure(*scene, estimator, 256, 2);
            // Roulette is the only thing left that can vary.
            EXPECT_NEAR(t.mean.y(), 1, 4.5 * t.error.y() + 2e-4) << material;
            EXPECT_LT(t.error.y(), 0.01) << material;
        }
}

// Lossy or rough materials give at most what arrives, and not much less where they should not.
TEST(Furnace, OtherMaterialsNeverAddEnergy) {
    // The least that may come back: for those with a diffuse part what that reflects alone; for
    // rough glass what single scattering by few-times masked facets cannot lose.
    struct Case {
        const char* material;
        double least;
    };
    const Case cases[] = {
        {"\"matte\" \"rgb Kd\" [1 1 1] \"float sigma\" [20]", 0.85},
        {"\"glass\" \"float uroughness\" [.01] \"float vroughness\" [.01] "
         "\"bool remaproughness\" \"false\"",
         0.98},
        {"\"glass\" \"float uroughness\" [.1] \"float vroughness\" [.1] "
         "\"bool remaproughness\" \"false\"",
         0.9},
        {"\"glass\" \"float uroughness\" [.3] \"float vroughness\" [.3]", 0},
        {"\"glass\" \"float eta\" [1.01] \"float uroughness\" [.2] \"float vroughness\" [.1]", 0},
        {"\"plastic\" \"rgb Kd\" [.5 .5 .5] \"rgb Ks\" [.5 .5 .5]", 0.5},
        {"\"uber\" \"rgb Kd\" [.3 .3 .3] \"rgb Ks\" [.2 .2 .2] \"rgb Kr\" [.2 .2 .2]", 0.3},
        {"\"metal\" \"float roughness\" [.1]", 0.4},
        {"\"translucent\"", 0.125},
    };
    for (const Case& c : cases) {
        const auto scene = MakeScene(kSky + "Material " + c.material + "\n" + kBall,
                                     "\"integer maxdepth\" [200]", 8, kClose);
        ImageMean totals[2];
        for (int i = 0; i < 2; ++i) {
            totals[i] = Measure(*scene, kEstimators[i], 400);
            EXPECT_LT(totals[i].mean.y(), 1 + 4.5 * totals[i].error.y() + 1e-4) << c.material;
            EXPECT_GT(totals[i].mean.y(), c.least) << c.material;
        }
        EXPECT_LT(std::abs(totals[0].mean.y() - totals[1].mean.y()),
                  4.5 * std::hypot(totals[0].error.y(), totals[1].error.y()) + 1e-4)
            << c.material;
    }
}

// A point light of intensity I at height h over a matte plane gives r I / (pi h^2) below it.
TEST(Furnace, PointLightOverAPlane) {
    const auto scene = MakeScene(
        "LightSource \"point\" \"rgb I\" [4 4 4] \"point from\" [0 0 -2]\n"
        "Material \"matte\" \"rgb Kd\" [.5 .5 .5]\n"
        "Shape \"trianglemesh\" \"integer indices\" [0 1 2 0 2 3]\n"
        "\"point P\" [-5 -5 0  5 -5 0  5 5 0  -5 5 0]",
        "", 1, "0 0 -3  0 0 0  0 1 0", 1);
    for (const Estimator estimator : kEstimators)
        EXPECT_NEAR(Measure(*scene, estimator, 16).mean.y(), 0.5 * 4 / (std::numbers::pi * 4),
                    1e-4);
}

// A room with lamps of every kind and specular things, so that every strategy matters.
constexpr const char* kRoom = R"(
LightSource "infinite" "rgb L" [.1 .1 .2]
LightSource "point" "rgb I" [.4 .4 .4] "point from" [.5 .5 -.8]
Material "matte" "rgb Kd" [.7 .7 .7]
Shape "trianglemesh" "integer indices" [0 1 2 0 2 3 4 5 6 4 6 7 8 9 10 8 10 11]
  "point P" [-1 -1 -1  1 -1 -1  1 -1 1  -1 -1 1    -1 1 -1  1 1 -1  1 1 1  -1 1 1
             -1 -1 1  1 -1 1  1 1 1  -1 1 1]
Material "plastic" "rgb Kd" [.6 .1 .1] "rgb Ks" [.3 .3 .3] "float roughness" [.1]
Shape "trianglemesh" "integer indices" [0 1 2 0 2 3]
  "point P" [-1 -1 -1  -1 -1 1  -1 1 1  -1 1 -1]
AttributeBegin
  AreaLightSource "diffuse" "rgb L" [4 4 3] "bool twosided" "true"
  Shape "trianglemesh" "integer indices" [0 1 2 0 2 3]
    "point P" [-.3 .9 -.3  .3 .9 -.3  .3 .9 .3  -.3 .9 .3]
AttributeEnd
AttributeBegin
  AreaLightSource "diffuse" "rgb L" [2 3 4]
  Translate .5 -.1 .3
  Shape "sphere" "float radius" [.2]
  Translate -1 .1 0
  Rotate 60 1 0 0
  Shape "disk" "float radius" [.2]
AttributeEnd
AttributeBegin
  Translate -.4 -.6 .2
  Material "mirror"
  Shape "sphere" "float radius" [.4]
AttributeEnd
AttributeBegin
  Translate .45 -.65 -.3
  Material "glass" "float uroughness" [.1] "float vroughness" [.1]
  Shape "sphere" "float radius" [.35]
AttributeEnd
)";

TEST(Estimators, AgreeAndCombinedVariesLess) {
    const auto scene =
        MakeScene(kRoom, "\"integer maxdepth\" [5]", 16, "0 0 -3.4  0 0 0  0 1 0", 39);
    const auto combined = MeasurePixels(*scene, Estimator::Combined, SamplerKind::Random, 1000, 11);
    const auto pbrt = MeasurePixels(*scene, Estimator::PbrtV3, SamplerKind::Random, 1000, 12);
    EXPECT_EQ(combined.rejected + pbrt.rejected, 0);
    for (int c = 0; c < 3; ++c) {
        double difference = 0, variance = 0, ours = 0, theirs = 0;
        int out = 0;
        for (size_t i = 0; i < combined.mean.size(); ++i) {
            const double v = (combined.variance[i][c] + pbrt.variance[i][c]) / 1000;
            const double d = combined.mean[i][c] - pbrt.mean[i][c];
            difference += d;
            variance += v;
            ours += combined.variance[i][c];
            theirs += pbrt.variance[i][c];
            out += std::abs(d) > 4 * std::sqrt(v);
        }
        EXPECT_LT(std::abs(difference), 4 * std::sqrt(variance));
        EXPECT_LE(out, 2);
        EXPECT_LT(ours, 1.1 * theirs);
    }
}

TEST(Estimators, LightStrategiesAgree) {
    std::vector<ImageMean> totals;
    for (const char* strategy : {"uniform", "power", "spatial"})
        for (const Estimator estimator : kEstimators) {
            const auto scene = MakeScene(
                kRoom, fmt::format("\"string lightsamplestrategy\" \"{}\"", strategy).c_str(), 12,
                "0 0 -3.4  0 0 0  0 1 0", 39);
            totals.push_back(Measure(*scene, estimator, 400, 20 + totals.size()));
        }
    for (size_t i = 1; i < totals.size(); ++i)
        EXPECT_LT(std::abs(totals[i].mean.y() - totals[0].mean.y()),
                  4.5 * std::hypot(totals[i].error.y(), totals[0].error.y()))
            << i;
}

// Returns the mean squared error of `samples` a pixel against `reference`, over a few seeds.
double SquaredError(const Scene& scene, const PixelStatistics& reference, SamplerKind kind,
                    int samples) {
    double sum = 0;
    for (uint64_t seed = 1; seed <= 4; ++seed) {
        const auto pixels = MeasurePixels(scene, Estimator::Combined, kind, samples, seed);
        for (size_t i = 0; i < pixels.mean.size(); ++i)
            sum += (pixels.mean[i] - reference.mean[i]).square().sum();
    }
    return sum;
}

// A plane over a translucent solid under an even sky: what the surface reflects, and of the rest
// the share that the solid lets out.
TEST(Subsurface, ReturnsItsAlbedoUnderAnEvenSky) {
    constexpr float kEta = 1.4f;
    const auto reflectance = [](float eta) {
        double sum = 0;
        for (int i = 0; i < 10000; ++i) {
            const float c = (float(i) + 0.5f) / 10000;
            sum += double(FresnelDielectric(c, eta) * 2 * c) / 10000;
        }
        return sum;
    };
    // Directions out of the solid are weighted by a fit of the reflectance.
    const double out = (1 - reflectance(kEta)) / (1 - 2 * FresnelMoment1(1 / double(kEta)));
    const double straight = FresnelDielectric(1, kEta);
    const double expected = straight + (1 - straight) * 0.6 * out;
    const auto scene = MakeScene(
        kSky +
            "Material \"kdsubsurface\" \"rgb Kd\" [.6 .6 .6] \"rgb mfp\" [.3 .1 .2] \"float eta\" "
            "1.4\nShape \"trianglemesh\" \"integer indices\" [0 1 2 0 2 3] \"point P\" "
            "[-90 -90 0 90 -90 0 90 90 0 -90 90 0]",
        "", 8, "0 0 2.5  0 0 0  0 1 0", 1);
    for (const Estimator estimator : kEstimators) {
        const ImageMean total = Measure(*scene, estimator, 2000);
        // 0.1 % is too far away to be looked for.
        EXPECT_NEAR(total.mean.y(), expected, 5 * total.error.y() + 0.002 * expected);
        EXPECT_LT(total.error.y(), 0.01);
    }
}

TEST(Sobol, ErrsLessThanRandom) {
    const auto scene =
        MakeScene(kRoom, "\"integer maxdepth\" [5]", 12, "0 0 -3.4  0 0 0  0 1 0", 39);
    const auto reference = MeasurePixels(*scene, Estimator::Combined, SamplerKind::Sobol, 4096, 99);
    for (const int samples : {16, 64})
        EXPECT_LT(SquaredError(*scene, reference, SamplerKind::Sobol, samples),
                  0.9 * SquaredError(*scene, reference, SamplerKind::Random, samples))
            << samples;
}

TEST(RenderSample, IsTheSameBitsInAnyOrder) {
    const auto scene = MakeScene(kRoom, "", 8, "0 0 -3.4  0 0 0  0 1 0", 39);
    // The tables of lights are made in another order here.
    const auto again = MakeScene(kRoom, "", 8, "0 0 -3.4  0 0 0  0 1 0", 39);
    for (const Estimator estimator : kEstimators)
        for (const SamplerKind kind : {SamplerKind::Random, SamplerKind::Sobol}) {
            Sampler forward(kind, 4), backward(kind, 4);
            std::vector<Rgb> radiance;
            for (int i = 0; i < 64 * 8; ++i)
                radiance.push_back(
                    RenderSample(*scene, estimator, forward, {i % 8, i / 8 % 8}, i / 64).radiance);
            for (int i = 64 * 8 - 1; i >= 0; --i)
                ASSERT_TRUE((RenderSample(*again, estimator, backward, {i % 8, i / 8 % 8}, i / 64)
                                 .radiance == radiance[i])
                                .all());
        }
}

}  // namespace
}  // namespace lull::furnace_test
