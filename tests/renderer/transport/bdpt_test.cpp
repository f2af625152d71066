// Compares bidirectional path tracing with paths from the camera where these find all light.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "tests/renderer/transport/bdpt_comparison.h"
#include "tests/shared_folder.h"

namespace lull {
namespace {

const std::string kBox =
    R"(Material "matte" "rgb Kd" [.5 .6 .7] )" + Quad("-2 -1 -2 2 -1 -2 2 -1 2 -2 -1 2") +
    Quad("-2 -1 2 2 -1 2 2 2 2 -2 2 2") +
    R"(Material "plastic" "rgb Kd" [.3 .1 .1] "rgb Ks" [.4 .4 .4] "float roughness" [.2]
TransformBegin Translate .3 -.4 .2 Shape "sphere" "float radius" [.6] TransformEnd
)";

class BdptLights : public testing::TestWithParam<NamedText> {};

// Every kind of light gives the same mean by paths and by all strategies.
TEST_P(BdptLights, HaveTheMeanOfPaths) {
    for (const int depth : {1, 4})
        Compare(BothOf(GetParam().text + kBox, 32, depth), 4, 32,
                fmt::format("{} to {} bounces", GetParam().name, depth), kWays);
}

INSTANTIATE_TEST_SUITE_P(
    Kinds, BdptLights,
    testing::Values(
        NamedText{"Area", R"(AttributeBegin Material "matte" "rgb Kd" [0 0 0]
AreaLightSource "diffuse" "rgb L" [4 3 2] )" +
                              Quad("-1 1.5 -1 0 1.5 -1 0 1.5 0 -1 1.5 0") + "AttributeEnd "},
        NamedText{
            "Sun",
            R"(LightSource "distant" "point from" [-1 3 -2] "rgb L" [2 2 2] "float angle" [5] )"},
        NamedText{
            "TwoSided",
            R"(AttributeBegin AreaLightSource "diffuse" "rgb L" [4 3 2] "bool twosided" "true" )" +
                Quad("-1 1.5 -1 0 .5 -1 0 .5 0 -1 1.5 0") + "AttributeEnd "},
        NamedText{"Sphere",
                  R"(AttributeBegin Translate -1 .8 0 AreaLightSource "diffuse" "rgb L" [4 3 2]
Shape "sphere" "float radius" [.3] AttributeEnd )"},
        NamedText{"Disk", R"(AttributeBegin Translate -1 1.2 0 Rotate 90 1 0 0
AreaLightSource "diffuse" "rgb L" [4 3 2] Shape "disk" "float radius" [.5] AttributeEnd )"},
        NamedText{"Cylinder",
                  R"(AttributeBegin Translate -1 .8 0 AreaLightSource "diffuse" "rgb L" [4 3 2]
Shape "cylinder" "float radius" [.2] "float zmin" [-.5] "float zmax" [.5] AttributeEnd )"},
        NamedText{"Point", R"(LightSource "point" "point from" [-1 1.5 -1] "rgb I" [3 4 5] )"},
        NamedText{
            "Spot",
            R"(LightSource "spot" "point from" [-1 1.5 -1] "point to" [0 -1 0] "rgb I" [30 40 50] )"},
        NamedText{
            "Distant",
            R"(LightSource "distant" "point from" [-1 2 -1] "point to" [0 0 0] "rgb L" [1 2 3] )"},
        NamedText{"Infinite", R"(LightSource "infinite" "rgb L" [1 2 3] )"},
        NamedText{"Projection", R"(AttributeBegin Translate -.5 1.5 -2 Rotate 40 1 0 0
LightSource "projection" "float fov" [50] "rgb I" [8 8 8] AttributeEnd )"},
        NamedText{
            "Goniometric",
            R"(AttributeBegin Translate -.5 1 -1 LightSource "goniometric" "rgb I" [3 3 3] AttributeEnd )"},
        NamedText{"Several", R"(LightSource "infinite" "rgb L" [.3 .2 .1]
LightSource "point" "point from" [-1 1.5 -1] "rgb I" [3 1 1] AttributeBegin Translate 1 1 0
AreaLightSource "diffuse" "rgb L" [4 3 2] Shape "sphere" "float radius" [.2] AttributeEnd )"}),
    kByName);

class BdptCameras : public testing::TestWithParam<NamedText> {};

TEST_P(BdptCameras, HaveTheMeanOfPaths) {
    Compare(BothOf("LightSource \"point\" \"point from\" [-1 1.5 -1] \"rgb I\" [3 4 5]\n" + kBox,
                   32, 3, GetParam().text),
            8, 32, GetParam().name, kWays);
}

INSTANTIATE_TEST_SUITE_P(
    Kinds, BdptCameras,
    testing::Values(
        NamedText{"Lens", R"(LookAt 0 0 -3  0 0 0  0 1 0 Camera "perspective" "float fov" [60]
"float lensradius" [.2] "float focaldistance" [2.5] )"},
        NamedText{"Shifted", R"(Scale -1 1 1 LookAt 0 0 -3  0 0 0  0 1 0
Camera "perspective" "float fov" [60] "float screenwindow" [-.7 .8 -.3 1] )"},
        NamedText{"Orthographic", R"(LookAt 0 0 -3  0 0 0  0 1 0
Camera "orthographic" "float screenwindow" [-1.5 1.5 -1.5 1.5] )"},
        NamedText{"Environment", R"(LookAt 0 0 -1.5  0 0 0  0 1 0 Camera "environment" )"}),
    kByName);

class BdptMaterials : public testing::TestWithParam<NamedText> {};

TEST_P(BdptMaterials, HaveTheMeanOfPaths) {
    const std::string world =
        "AttributeBegin Translate -1 1.2 -1 AreaLightSource \"diffuse\" \"rgb L\" [9 8 7]\n"
        "Shape \"sphere\" \"float radius\" [.4] AttributeEnd\n" +
        kBox + GetParam().text +
        "\nTransformBegin Translate -.7 -.3 -.5 Shape \"sphere\" \"float radius\" [.5] "
        "TransformEnd\n";
    Compare(BothOf(world, 32, 5), 16, 32, GetParam().name, kWays);
}

INSTANTIATE_TEST_SUITE_P(
    Kinds, BdptMaterials,
    testing::Values(
        NamedText{"Glass", R"(Material "glass")"},
        NamedText{"RoughGlass",
                  R"(Material "glass" "float uroughness" [.3] "float vroughness" [.3])"},
        NamedText{"Mirror", R"(Material "mirror")"},
        NamedText{"Metal", R"(Material "metal" "float roughness" [.1])"},
        NamedText{"Uber",
                  R"(Material "uber" "rgb Kd" [.2 .3 .2] "rgb Ks" [.2 .2 .2] "rgb Kr" [.2 .2 .2]
"rgb Kt" [.2 .1 .1] "rgb opacity" [.7 .7 .7])"},
        NamedText{"Substrate", R"(Material "substrate" "rgb Kd" [.5 .2 .2] "rgb Ks" [.3 .3 .3])"},
        NamedText{"Translucent", R"(Material "translucent")"},
        NamedText{"Disney", R"(Material "disney" "rgb color" [.6 .3 .2] "float metallic" [.3]
"float clearcoat" [.5] "float sheen" [.4])"},
        NamedText{"Mix", R"(MakeNamedMaterial "a" "string type" "mirror"
MakeNamedMaterial "b" "string type" "matte"
Material "mix" "string namedmaterial1" "a" "string namedmaterial2" "b")"}),
    kByName);

const std::string kLamp =
    "AttributeBegin Translate -.8 .9 0 AreaLightSource \"diffuse\" \"rgb L\" [9 8 7]\n"
    "Shape \"sphere\" \"float radius\" [.3] AttributeEnd\n";

// No light path is seen from within, but for those that no strategy can connect.
TEST(BdptHardCases, CameraInsideGlass) {
    Compare(BothOf(kLamp + kBox +
                       "Material \"glass\" TransformBegin Translate 0 0 -3 Shape \"sphere\" "
                       "\"float radius\" [.3] TransformEnd\n",
                   32, 5),
            8, 32, "camera inside glass", kWays);
}

// Paths from lights scatter at shading normals as those from the camera do. (After more bounces
// these miss light from between the planes of both normals, as pbrt-v3's.)
TEST(BdptHardCases, TiltedNormals) {
    Compare(BothOf(kLamp + R"(Material "matte" "rgb Kd" [.5 .6 .7]
Shape "trianglemesh" "integer indices" [0 1 2 0 2 3] "point P" [-2 -1 -2 2 -1 -2 2 -1 2 -2 -1 2]
"normal N" [.7 .7 0 .7 .7 0 -.7 .7 0 -.7 .7 0]
Shape "trianglemesh" "integer indices" [0 1 2 0 2 3] "point P" [-2 -1 2 2 -1 2 2 2 2 -2 2 2]
"normal N" [0 .7 -.7 0 .7 -.7 0 -.7 -.7 0 -.7 -.7]
)",
                   32, 1),
            16, 32, "tilted normals", kWays);
}

TEST(BdptHardCases, RoomOfMirrors) {
    Compare(BothOf(kLamp + "Material \"matte\" \"rgb Kd\" [.5 .6 .7]\n"
                           "Shape \"sphere\" \"float radius\" [.5]\n"
                           "Material \"mirror\" \"rgb Kr\" [.8 .8 .8]\n"
                           "Shape \"trianglemesh\" \"integer indices\" [0 1 2 0 2 3 4 5 6 4 6 7 3 "
                           "2 6 3 6 7 0 1 5 0 5 4 0 3 7 0 7 4 1 2 6 1 6 5] \"point P\" [-2 -1 -4  "
                           "2 -1 -4  2 -1 2  -2 -1 2  -2 2 -4  2 2 -4  2 2 2  -2 2 2]\n",
                   32, 6),
            8, 32, "room of mirrors", kWays);
}

struct Room {
    const char* name;
    std::string file;
    int maxDepth, spp;
};

class BdptScenes : public testing::TestWithParam<Room> {};

// Where paths find all light, so do all strategies together.
TEST_P(BdptScenes, HaveTheMeanOfPaths) {
    const auto& [name, own, maxDepth, spp] = GetParam();
    const std::string file = own.starts_with("/") ? own : (SharedFolder() / own).string();
    if (!std::filesystem::exists(file))
        GTEST_SKIP() << "scenes of others are not in ../shared: " << file;
    constexpr BdptShares all[] = {kAll, kFew};
    Compare(Both(file, 40, maxDepth), spp, 16, name, all);
}

INSTANTIATE_TEST_SUITE_P(
    Of, BdptScenes,
    testing::Values(Room{"Glossy", LULL_SCENES_DIR "/glossy/scene.pbrt", 4, 8},
                    Room{"ManyLights", LULL_SCENES_DIR "/many-lights/scene.pbrt", 3, 4},
                    Room{"CornellBox", "pbrt-scenes/cornell-box/scene.pbrt", 5, 8},
                    Room{"VeachMis", "pbrt-scenes/veach-mis/scene.pbrt", 4, 8},
                    Room{"Staircase2", "pbrt-scenes/staircase2/scene.pbrt", 4, 8},
                    Room{"Matpreview", "pbrt-scenes/matpreview/scene.pbrt", 4, 8},
                    Room{"Killeroo", "pbrt-scenes/killeroo-simple/scene.pbrt", 4, 8}),
    kByName);

}  // namespace
}  // namespace lull

// Compares bidirectional path tracing with pbrt-v3's own, of its random sampler: means of blocks of
// pixels, R + G + B, and their standard errors over pictures of different seeds.
namespace lull::bdpt_reference_test {
namespace {

struct Reference {
    double mean, error;
};

void Compare(const Scene& scene, const BdptShares& shares, int spp, int pictures, int side,
             std::span<const Reference> reference) {
    const BlockMeans ours = MeasureBlocks(scene, shares, spp, pictures, side);
    ASSERT_EQ(ours.mean.size(), reference.size());
    int out = 0;
    double difference = 0, variance = 0;
    for (size_t i = 0; i < reference.size(); ++i) {
        const double scale = double(scene.film.scale);
        const double d = scale * ours.mean[i].sum() - reference[i].mean;
        const double e = std::hypot(scale * ours.error[i].sum(), reference[i].error);
        difference += d;
        variance += e * e;
        // Half of a 16-bit float's last place is what the reference itself may be off by.
        out += std::abs(d) > 3.5 * e + 5e-4 * reference[i].mean;
    }
    EXPECT_LE(out, 1);
    EXPECT_LT(std::abs(difference), 4 * std::sqrt(variance)) << std::sqrt(variance);
}

constexpr BdptShares kWays[] = {{1, 1}, {0.3f, 0.1f}};

// 8 pictures of 512 spp.
TEST(BdptReference, LampInAGlassBall) {
    constexpr Reference kPbrt[] = {{0.05461, 0.00032}, {0.81948, 0.00116}, {1.15419, 0.00208},
                                   {0.10091, 0.00037}, {0.00000, 0.00000}, {0.63151, 0.00160},
                                   {0.67024, 0.00112}, {0.00000, 0.00000}, {0.05272, 0.00028},
                                   {0.52436, 0.00130}, {0.61689, 0.00139}, {0.07255, 0.00034}};
    const auto scene = SceneOf(R"(
LookAt 0 0 -3  0 0 0  0 1 0
Camera "perspective" "float fov" [45]
Film "image" "integer xresolution" [32] "integer yresolution" [24]
PixelFilter "box"
Integrator "bdpt" "integer maxdepth" [6]
WorldBegin
LightSource "point" "point from" [.2 .3 0] "rgb I" [3 2 1]
AttributeBegin
Material "glass" Translate .2 .3 0 Shape "sphere" "float radius" [.2]
AttributeEnd
Material "matte" "rgb Kd" [.7 .5 .3]
Shape "trianglemesh" "integer indices" [0 1 2 0 2 3 4 5 6 4 6 7 3 2 6 3 6 7]
  "point P" [-1 -1 -1  1 -1 -1  1 -1 1  -1 -1 1   -1 1 -1  1 1 -1  1 1 1  -1 1 1]
WorldEnd
)");
    for (const BdptShares& shares : kWays) Compare(*scene, shares, 32, 16, 8, kPbrt);
}

// 4 pictures of 40 spp, of at most 20 bounces.
TEST(BdptReference, CausticGlass) {
    constexpr Reference kPbrt[] = {
        {0.50965, 0.00101}, {0.83875, 0.00203}, {1.23039, 0.00311}, {1.09774, 0.00195},
        {0.68682, 0.00078}, {0.64467, 0.00268}, {0.64623, 0.00362}, {0.80414, 0.00134},
        {0.39788, 0.00191}, {1.11408, 0.00590}, {0.55299, 0.00305}, {0.62758, 0.00172},
        {0.54695, 0.00517}, {0.79440, 0.00363}, {0.33447, 0.00176}, {0.55139, 0.00123}};
    LULL_SHARED_FILE(file, "pbrt-scenes/caustic-glass/scene.pbrt");
    const auto scene = Both(file.string(), 96, 20).bdpt;
    for (const BdptShares& shares : kWays) Compare(*scene, shares, 4, 16, 24, kPbrt);
}

}  // namespace
}  // namespace lull::bdpt_reference_test
