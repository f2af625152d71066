// Checks the light that goes straight through panes: by its known share, by both estimators, by
// bidirectional path tracing, and in renders that learn.
#include "renderer/transport/path_media.h"

#include "renderer/base/math.h"
#include "tests/renderer/transport/bdpt_comparison.h"
#include "tests/renderer/transport/pixel_statistics.h"

namespace lull::panes_test {
namespace {

const std::string kSheet =
    "Material \"metallicroughness\" \"float metallicfactor\" [0] \"float roughnessfactor\" [0] "
    "\"float transmissionfactor\" [1] ";
constexpr const char* kTint = "\"rgb basecolorfactor\" [.9 .6 .3] ";
// Reflects nothing, so that it lets the same share through at any angle.
constexpr const char* kNoInterface = "\"float specularfactor\" [0] ";

// A roof over the box at this height.
std::string Roof(const std::string& material, double y = 0.9) {
    return fmt::format("AttributeBegin {}\nTranslate 0 {} 0\n{}AttributeEnd\n", material, y,
                       Quad("-2.1 0 -2.1  2.1 0 -2.1  2.1 0 2.1  -2.1 0 2.1"));
}

// A box that is open above, where all light comes from, with a glossy ball in it.
const std::string kBox =
    "Material \"matte\" \"rgb Kd\" [.5 .6 .7]\n" + Quad("-2 -1 -2  2 -1 -2  2 -1 2  -2 -1 2") +
    Quad("-2 -1 2  2 -1 2  2 .9 2  -2 .9 2") + Quad("-2 -1 -2  2 -1 -2  2 .9 -2  -2 .9 -2") +
    Quad("-2 -1 -2  -2 -1 2  -2 .9 2  -2 .9 -2") + Quad("2 -1 -2  2 -1 2  2 .9 2  2 .9 -2") +
    "Material \"plastic\" \"rgb Kd\" [.3 .1 .1] \"rgb Ks\" [.4 .4 .4] "
    "\"float roughness\" [.1]\n"
    "TransformBegin Translate .3 -.5 .2 Shape \"sphere\" \"float radius\" "
    "[.5] TransformEnd\n";
const std::string kCamera =
    "LookAt 0 .2 -1.9  0 -.6 0  0 1 0\n"
    "Camera \"perspective\" \"float fov\" [80]\n";

const std::string kArea =
    R"(AttributeBegin Material "matte" "rgb Kd" [0 0 0] AreaLightSource "diffuse" "rgb L" [4 4 4] )" +
    Quad("-1 1.5 -1  0 1.5 -1  0 1.5 0  -1 1.5 0");
const NamedText kLit[] = {
    {"Sun", R"(LightSource "distant" "point from" [1 3 .5] "rgb L" [2 2 2] )"},
    {"Disc", R"(LightSource "distant" "point from" [1 3 .5] "rgb L" [2 2 2] "float angle" [20] )"},
    {"Point", R"(LightSource "point" "point from" [.5 1.5 -.3] "rgb I" [3 3 3] )"},
    {"Spot", R"(LightSource "spot" "point from" [.5 2 -.3] "point to" [0 0 0] "float coneangle" [50]
"rgb I" [6 6 6] )"},
    {"Area", kArea + "AttributeEnd "},
    {"Hidden", kArea + R"("float alpha" [0] AttributeEnd )"},
    {"Sphere", R"(AttributeBegin Translate -.5 1.5 0 Material "matte" "rgb Kd" [0 0 0]
AreaLightSource "diffuse" "rgb L" [4 4 4] Shape "sphere" "float radius" [.3] AttributeEnd )"},
    {"Sky", R"(LightSource "infinite" "rgb L" [1 1 1] )"},
    {"Studio", R"(LightSource "infinite" "bool studio" "true" )"},
};

constexpr const char* kHalf =
    R"(Material "metallicroughness" "float metallicfactor" [.2] "float roughnessfactor" [0]
"float transmissionfactor" [.5] "rgb basecolorfactor" [.9 .6 .3])";

std::unique_ptr<const Scene> Compiled(const std::string& world, int maxDepth,
                                      const std::string& integrator = "path") {
    CompileOptions options;
    options.film.resolution = Vec2i(16, 16);
    options.maxDepth = maxDepth;
    return SceneOf(
        WorldText(world, kCamera + "PixelFilter \"box\"\nIntegrator \"" + integrator + "\"\n"),
        options);
}

ImageMean Measure(const Scene& scene, Estimator estimator, uint64_t seed, int samples = 300) {
    const PixelStatistics pixels =
        MeasurePixels(scene, estimator, SamplerKind::Random, std::max(1, samples / kFewer), seed);
    EXPECT_EQ(pixels.rejected, 0);
    return MeanOf(pixels);
}

void ExpectEqual(const ImageMean& a, const ImageMean& b, const std::string& what) {
    for (int c = 0; c < 3; ++c) {
        EXPECT_GT(a.mean[c], 0) << what;
        EXPECT_NEAR(a.mean[c], b.mean[c],
                    4.5 * std::hypot(a.error[c], b.error[c]) + 1e-5 * b.mean[c])
            << what << " " << c;
    }
}

class Panes : public testing::TestWithParam<NamedText> {};

// Two tinted panes let the square of their colour through, of all light that lights bring, directly
// and by other ways.
TEST_P(Panes, LetTheirShareThrough) {
    const std::string pane = kSheet + kTint + kNoInterface;
    const std::string lit = GetParam().text + kBox;
    for (const int depth : {1, 6})
        for (const Estimator estimator : kEstimators) {
            ImageMean open = Measure(*Compiled(lit, depth), estimator, 1);
            const Eigen::Array3d share = Eigen::Array3d(0.9, 0.6, 0.3).square();
            open.mean *= share;
            open.error *= share;
            ExpectEqual(
                Measure(*Compiled(lit + Roof(pane) + Roof(pane, 0.901), depth), estimator, 2), open,
                fmt::format("{} bounces, {}", depth, int(estimator)));
        }
}

// Glass is an interface that reflects by the angle, coats and tints of all sorts, and a base: the
// mean is that of paths from the lights as well.
TEST_P(Panes, HaveTheMeanOfBidirectionalPaths) {
    const std::string glass = kSheet + kTint;
    const std::string coated =
        glass + "\"float clearcoatfactor\" [1] \"float clearcoatroughnessfactor\" [.3]";
    if (GetParam().name == "Hidden")
        GTEST_SKIP() << "a light that is not seen has another weight in bdpt";
    for (const int depth : {1, 5})
        for (const std::string& roof : {Roof(glass) + Roof(coated, 1.1), Roof(kHalf)})
            Compare(BothOf(GetParam().text + kBox + roof, 16, depth, kCamera), 8, 16,
                    fmt::format("{}, {} bounces, {}", GetParam().name, depth, roof), kWays);
}

// With both estimators, and where shadow rays go through interfaces of media as well.
TEST_P(Panes, HaveOneMean) {
    const std::string world = GetParam().text + kBox + Roof(kHalf) + Roof(kSheet + kTint, 0.901);
    const std::string mist =
        "AttributeBegin Material \"\" Translate -.6 0 0 Shape \"sphere\" \"float radius\" [.4] "
        "AttributeEnd\n";
    const auto scene = Compiled(world, 5), misty = Compiled(world + mist, 5, "volpath");
    ASSERT_TRUE(scene->hasPanes && !scene->isVolumetric && misty->isVolumetric);
    const ImageMean combined = Measure(*scene, Estimator::Combined, 1);
    ExpectEqual(Measure(*scene, Estimator::PbrtV3, 2), combined, "pbrt-v3's estimator");
    ExpectEqual(Measure(*misty, Estimator::Combined, 3), combined, "in a medium");
    ExpectEqual(Measure(*misty, Estimator::PbrtV3, 4), combined, "in a medium, pbrt-v3's");
}

INSTANTIATE_TEST_SUITE_P(Kinds, Panes, testing::ValuesIn(kLit), kByName);

// The sun through a pane, at an angle: the light that Schlick's approximation leaves.
TEST(PaneLight, DependsOnTheAngle) {
    const double cosine = std::cos(60 * double(kPi) / 180);
    const std::string world =
        "LightSource \"distant\" \"point from\" [0 .5 .8660254] \"point to\" [0 0 0]\n" + kBox;
    const ImageMean open = Measure(*Compiled(world, 1), Estimator::Combined, 1, 64),
                    closed =
                        Measure(*Compiled(world + Roof(kSheet), 1), Estimator::Combined, 1, 64);
    const double reflected = 0.04 + 0.96 * std::pow(1 - cosine, 5);
    EXPECT_NEAR(closed.mean.y() / open.mean.y(), 1 - reflected, 1e-4);
}

// Whatever is no smooth sheet, or has nothing behind it to let through, stops shadow rays.
TEST(PaneLight, PassesSmoothSheetsAlone) {
    const auto shareOf = [](const std::string& material, double alpha = 1) {
        const auto scene = Compiled(
            fmt::format(
                "AttributeBegin {}\n"
                "Shape \"trianglemesh\" \"integer indices\" [0 1 2] \"point P\" [-2 0 -2  2 "
                "0 -2  0 0 2] \"float shadowalpha\" [{}] AttributeEnd\n",
                material, alpha) +
                Roof(kSheet, 5),
            1);
        EXPECT_TRUE(scene->hasPanes);
        return ShareAlong(*scene, {{0, -1, 0}, {0, 2, 0}, 1}, 0);
    };
    const std::string sheet = kSheet;
    EXPECT_TRUE(shareOf(sheet).isApprox(Rgb::Constant(0.96f), 1e-4f));
    EXPECT_TRUE(shareOf(sheet + kTint + kNoInterface).isApprox(Rgb(0.9f, 0.6f, 0.3f), 1e-4f));
    EXPECT_TRUE(IsBlack(shareOf(sheet + "\"bool solid\" \"true\"")));
    EXPECT_TRUE(IsBlack(shareOf("Material \"glass\"")));
    EXPECT_TRUE(IsBlack(shareOf(
        "Material \"metallicroughness\" \"float metallicfactor\" [0] \"float roughnessfactor\" "
        "[.2] \"float transmissionfactor\" [1]")));
    EXPECT_TRUE((shareOf("Material \"matte\"", 0) == 1).all());
    EXPECT_TRUE(IsBlack(shareOf("Material \"matte\"")));
}

// Rays that end on either side of a pane, or in it, come to an end.
TEST(PaneLight, EndsWhereTheRayDoes) {
    const auto scene = Compiled(Roof(kSheet, 1) + Roof(kSheet, 2), 1);
    const auto share = [&](float length) {
        return ShareAlong(*scene, {{0.1f, 0, 0.1f}, {0, length, 0}, 1}, 0).y();
    };
    EXPECT_EQ(share(0.99f), 1);
    EXPECT_NEAR(share(1.5f), 0.96f, 1e-4f);
    EXPECT_NEAR(share(2.5f), 0.96f * 0.96f, 1e-4f);
    for (int i = -100; i <= 100; ++i) {
        const float s = share(1 + float(i) * 1e-7f);
        EXPECT_TRUE(s == 1 || std::abs(s - 0.96f) < 1e-4f) << s;
    }
}

// A pane is no bounce: what is behind it is lit, and lights are seen, at any depth.
TEST(PaneLight, CountsNoBounces) {
    const std::string sky = "LightSource \"infinite\" \"rgb L\" [1 1 1]\n";
    std::string panes;
    for (int i = 0; i < 8; ++i) panes += Roof(kSheet + kTint + kNoInterface, 0.3 + 0.1 * i);
    const double share = std::pow(0.6, 8);
    const auto up = [&](const std::string& world, int depth) {
        CompileOptions options;
        options.film.resolution = Vec2i(2, 2);
        options.maxDepth = depth;
        const auto scene =
            SceneOf(WorldText(world,
                              "LookAt 0 0 0  0 1 0  0 0 1\nCamera \"orthographic\" \"float "
                              "screenwindow\" [-.1 .1 -.1 .1]\n"),
                    options);
        return Measure(*scene, Estimator::Combined, 1, 64).mean.y();
    };
    EXPECT_NEAR(up(sky + panes, 0), share, 1e-4);
    EXPECT_NEAR(up(sky + panes, 3), share, 1e-4);
}

}  // namespace
}  // namespace lull::panes_test
