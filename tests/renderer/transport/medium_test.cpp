// Compares path tracing in media with scenes whose radiance is known, and its estimators with each
// other.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "tests/renderer/scene_of.h"
#include "tests/renderer/transport/pixel_statistics.h"

namespace lull {
namespace {

std::unique_ptr<const Scene> MakeMediumScene(const std::string& world,
                                             const std::string& before = "", int depth = 1000,
                                             const char* view = "0 0 -2.5  0 0 0  0 1 0") {
    return SceneOf(WorldText(
        world, fmt::format("Film \"image\" \"integer xresolution\" 8 \"integer yresolution\" 8\n"
                           "Integrator \"volpath\" \"integer maxdepth\" {}\nLookAt {}\n{}\n"
                           "Camera \"perspective\" \"float fov\" 40",
                           depth, view, before)));
}

// Expects the mean of the green channel over the image.
void ExpectMean(const Scene& scene, Estimator estimator, double expected, int samples = 256,
                double slack = 1e-4) {
    const auto pixels = MeasurePixels(scene, estimator, SamplerKind::Random, samples, 1);
    EXPECT_EQ(pixels.rejected, 0);
    const ImageMean image = MeanOf(pixels);
    EXPECT_NEAR(image.mean.y(), expected, 4.5 * image.error.y() + slack);
}

std::string Medium(double absorption, double scattering, double g = 0) {
    return fmt::format(
        "MakeNamedMedium \"m\" \"string type\" \"homogeneous\" \"rgb sigma_a\" [{0} {0} {0}] "
        "\"rgb sigma_s\" [{1} {1} {1}] \"float g\" {2}\n",
        absorption, scattering, g);
}

constexpr const char* kWhiteSky = "LightSource \"infinite\" \"rgb L\" [1 1 1]\n";
constexpr const char* kMediumBall =
    "Material \"none\"\nMediumInterface \"m\" \"\"\nShape \"sphere\" \"float radius\" 2\n";

// pbrt-v4's media that emit, in a box without lights: Le sigma_a / sigma_t (1 - exp(-sigma_t d)),
// seen along its depth of 2, but not where paths have no bounce.
TEST(Medium, EmitsInPbrtV4) {
    const auto mean = [](const std::string& medium, int depth) {
        Warnings warnings;
        const auto scene = SceneOf(
            fmt::format(
                "Film \"rgb\" \"integer xresolution\" 4 \"integer yresolution\" 4\n"
                "Integrator \"volpath\" \"integer maxdepth\" {}\nLookAt 0 0 -3 0 0 0 0 1 0\n"
                "Camera \"orthographic\" \"float screenwindow\" [-.1 .1 -.1 .1]\nWorldBegin\n"
                "MakeNamedMedium \"m\" \"string type\" {}\nMaterial \"interface\"\n"
                "MediumInterface \"m\" \"\"\nScale 10 10 1\nShape \"trianglemesh\" "
                "\"point3 P\" [-1 -1 -1 1 -1 -1 1 1 -1 -1 1 -1 -1 -1 1 1 -1 1 1 1 1 -1 1 1] "
                "\"integer indices\" [0 2 1 0 3 2 4 5 6 4 6 7]\n",
                depth, medium),
            {}, &warnings);
        EXPECT_EQ(warnings.Total(), 0);
        return MeanOf(MeasurePixels(*scene, Estimator::Combined, SamplerKind::Random, 2000, 1));
    };
    const std::string absorbs = " \"rgb sigma_s\" [0 0 0] \"rgb sigma_a\" [.2 .4 .1] ";
    const Eigen::Array3d slab = 1 - (-2 * Eigen::Array3d(0.2, 0.4, 0.1)).exp();
    const auto expect = [&](const std::string& medium, const Eigen::Array3d& Le) {
        const ImageMean found = mean(medium, 1);
        EXPECT_TRUE(((found.mean - Le * slab).abs() <= 4.5 * found.error + 2e-4 * Le).all())
            << medium << found.mean.transpose() << " not " << (Le * slab).transpose();
        EXPECT_EQ(mean(medium, 0).mean.maxCoeff(), 0);
    };
    expect("\"homogeneous\" \"rgb Le\" [1 2 3] \"float Lescale\" 2" + absorbs, {2, 4, 6});
    expect("\"homogeneous\" \"spectrum Le\" \"stdillum-D65\"" + absorbs, {1, 1, 1});
    // A grid is the same between the middles of its cells.
    const auto eight = [](const std::string& what, const std::string& value) {
        std::string text = " \"" + what + "\" [";
        for (int i = 0; i < 8; ++i) text += value + ' ';
        return text + "]";
    };
    const std::string box =
        " \"integer nx\" 2 \"integer ny\" 2 \"integer nz\" 2 \"point3 p0\" [-9 -9 -9] "
        "\"point3 p1\" [9 9 9]";
    expect("\"uniformgrid\" \"rgb Le\" [1 2 3]" + eight("float density", "1") +
               eight("float Lescale", "1") + box + absorbs,
           {1, 2, 3});
    expect("\"rgbgrid\" \"float Lescale\" .01" + box + eight("rgb Le", "1 2 3") +
               eight("rgb sigma_a", ".2 .4 .1") + eight("rgb sigma_s", "0 0 0"),
           106.8569 * Eigen::Array3d(.01, .02, .03));
}

// Nothing is lost in a medium of albedo 1, however often it scatters: 1,000 times and more.
TEST(Medium, WhiteFurnace) {
    for (const Estimator estimator : kEstimators)
        for (const auto& [scattering, g, samples] :
             {std::tuple(0.3, 0.0, 256), std::tuple(3.0, 0.7, 128), std::tuple(20.0, -0.5, 8)})
            ExpectMean(
                *MakeMediumScene(Medium(0, scattering, g) + kWhiteSky + kMediumBall, "", 100000),
                estimator, 1, samples, 2e-3);
}

// A grid as white, and a glass ball full of it.
TEST(Medium, WhiteFurnaceOfGridsAndGlass) {
    const std::string grid =
        "MakeNamedMedium \"m\" \"string type\" \"heterogeneous\" \"integer nx\" 2 "
        "\"float density\" [1 4] \"point p0\" [-2 -2 -2] \"point p1\" [2 2 2] "
        "\"rgb sigma_a\" [0 0 0] \"rgb sigma_s\" [.7 .7 .7] \"float g\" .2\n";
    for (const Estimator estimator : kEstimators) {
        ExpectMean(*MakeMediumScene(grid + kWhiteSky + kMediumBall, "", 100000), estimator, 1, 128,
                   2e-3);
        ExpectMean(*MakeMediumScene(Medium(0, 1) + kWhiteSky +
                                        "Material \"glass\"\nMediumInterface \"m\" \"\"\n"
                                        "Shape \"sphere\" \"float radius\" 2\n",
                                    "", 100000),
                   estimator, 1, 128, 2e-3);
    }
}

// Absorption alone: exp(-sigma d), seen straight through a slab and for a camera inside.
TEST(Medium, AbsorbsByBeerAndLambert) {
    const std::string lamp =
        "AreaLightSource \"diffuse\" \"rgb L\" [1 1 1] \"bool twosided\" \"true\"\n"
        "Translate 0 0 2\nShape \"disk\" \"float radius\" 100\n";
    const std::string slab =
        "AttributeBegin\nMaterial \"none\"\nMediumInterface \"m\" \"\"\n"
        "Translate 0 0 .5\nReverseOrientation\nShape \"disk\" \"float radius\" 50\n"
        "AttributeEnd\nAttributeBegin\nMaterial \"none\"\nMediumInterface \"m\" \"\"\n"
        "Translate 0 0 1\nShape \"disk\" \"float radius\" 50\nAttributeEnd\n";
    for (const Estimator estimator : kEstimators) {
        // A pencil of rays along z: those of the narrow view differ by less than 1e-4 in length.
        const auto narrow = [&](const std::string& world, const std::string& before) {
            return MakeMediumScene(world, "Scale 100 100 1\n" + before, 5);
        };
        ExpectMean(*narrow(Medium(1.5, 0) + slab + lamp, ""), estimator, std::exp(-0.75), 64, 2e-4);
        // The lamp is at distance 4.5 from the camera, which is in the medium.
        ExpectMean(*narrow("MediumInterface \"m\" \"m\"\n" + lamp, Medium(0.3, 0)), estimator,
                   std::exp(-0.3 * 4.5), 64, 2e-4);
    }
}

// A medium of density 0 is none, and shadow rays go through interfaces.
TEST(Medium, OfDensityZeroChangesNothing) {
    const std::string floor = "Material \"matte\"\nShape \"sphere\" \"float radius\" 1\n";
    const std::string light = "LightSource \"point\" \"point from\" [1 2 -4] \"rgb I\" [9 9 9]\n";
    const auto plain = MakeMediumScene(light + floor, "", 5);
    const auto pixels = MeasurePixels(*plain, Estimator::PbrtV3, SamplerKind::Random, 256, 3);
    const double expected = MeanOf(pixels).mean.y();
    EXPECT_FALSE(plain->isVolumetric);
    for (const Estimator estimator : kEstimators) {
        const auto scene = MakeMediumScene(Medium(0, 0) + light + floor + kMediumBall, "", 5);
        EXPECT_TRUE(scene->isVolumetric);
        ExpectMean(*scene, estimator, expected, 256, 3e-2);
    }
}

void ExpectEstimatorsAgree(const Scene& scene) {
    const auto meanOf = [&](Estimator estimator, uint64_t seed) {
        return MeanOf(MeasurePixels(scene, estimator, SamplerKind::Random, 1000, seed));
    };
    const ImageMean a = meanOf(Estimator::Combined, 1), b = meanOf(Estimator::PbrtV3, 2);
    const Eigen::Array3d error = (a.error.square() + b.error.square()).sqrt();
    EXPECT_TRUE(((a.mean - b.mean).abs() < 4 * error).all())
        << a.mean.transpose() << ", " << b.mean.transpose() << " with " << error.transpose();
}

// The two estimators agree where neither surfaces nor media alone would.
TEST(Medium, EstimatorsAgree) {
    const std::string world =
        Medium(0.2, 0.8, 0.3) + kWhiteSky +
        "AttributeBegin\nAreaLightSource \"diffuse\" \"rgb L\" [20 20 20]\nTranslate 1 1.5 -1\n"
        "Shape \"sphere\" \"float radius\" .2\nAttributeEnd\n"
        "AttributeBegin\nMaterial \"plastic\"\nMediumInterface \"m\" \"m\"\n"
        "Shape \"sphere\" \"float radius\" .7\nAttributeEnd\n" +
        kMediumBall;
    ExpectEstimatorsAgree(*MakeMediumScene(world, "", 12));
}

// In a medium without an end the sky is seen by those samples of it alone that come from twice the
// scene's radius away, but for a channel that it lets through.
TEST(Medium, EstimatorsAgreeWithoutAnEnd) {
    const std::string ball =
        "MediumInterface \"m\" \"m\"\nMaterial \"matte\"\n"
        "Shape \"sphere\" \"float radius\" .7\n";
    const std::string medium =
        "MakeNamedMedium \"m\" \"string type\" \"homogeneous\" \"rgb sigma_a\" [0 .1 .4]\n"
        "\"rgb sigma_s\" [0 .2 0]\nMediumInterface \"\" \"m\"\n";
    const auto scene = MakeMediumScene(kWhiteSky + ball, medium, 3);
    ExpectEstimatorsAgree(*scene);
    const auto pixels = MeasurePixels(*scene, Estimator::Combined, SamplerKind::Random, 64, 3);
    const Eigen::Array3d middle = pixels.mean[pixels.mean.size() / 2 + 4];
    EXPECT_GT(middle.x(), 0.3);
    EXPECT_GT(middle.y(), 0.01);
    EXPECT_GT(middle.z(), 0.003);
}

}  // namespace
}  // namespace lull
