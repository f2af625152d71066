// Checks that skins, morph targets and animations pose glTF files as their specification says.
#include "tests/renderer/input/gltf_files.h"

namespace lull::gltf_poses_test {
namespace {

constexpr float kHalf = 0.70710678f;  // of a quaternion: a quarter turn

// A strip along x whose right end follows a joint at x = 1, its middle both joints. The joints
// stand in a node at height 3; the joint at the end is turned by a quarter about z.
GltfFile Arm() {
    GltfFile file;
    const int p = file.Floats({0, 0, 0, 1, 0, 0, 2, 0, 0}, "VEC3");
    const int n = file.Floats({0, 1, 0, 0, 1, 0, 0, 1, 0}, "VEC3");
    const int joints = file.Accessor(
        file.View(std::vector<uint8_t>{0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0}), 5121, 3, "VEC4");
    const int weights = file.Floats({1, 0, 0, 0, 0.25, 0.25, 0, 0, 0, 1, 0, 0}, "VEC4");
    std::vector<float> inverse(32, 0.f);
    for (size_t m = 0; m < 2; ++m)
        for (size_t i = 0; i < 4; ++i) inverse[16 * m + 5 * i] = 1;
    inverse[16 + 12] = -1;  // the second joint lay at x = 1
    file.root["accessors"].push_back({{"bufferView", file.View(inverse)},
                                      {"componentType", 5126},
                                      {"count", 2},
                                      {"type", "MAT4"}});
    const int bind = int(file.root["accessors"].size()) - 1;
    const int mesh =
        file.Mesh({{"POSITION", p}, {"NORMAL", n}, {"JOINTS_0", joints}, {"WEIGHTS_0", weights}});
    file.Node({{"mesh", mesh}, {"skin", 0}, {"translation", {50, 60, 70}}, {"scale", {9, 9, 9}}});
    file.Node({{"translation", {0, 0, 3}}, {"children", {2}}});
    file.root["nodes"].push_back(
        {{"translation", {1, 0, 0}}, {"rotation", {0, 0, kHalf, kHalf}}, {"name", "elbow"}});
    file.root["skins"] = {{{"joints", {1, 2}}, {"inverseBindMatrices", bind}}};
    return file;
}

TEST(GltfSkins, MoveVerticesByJointsAlone) {
    const Description d = kFolder.ParseSilently(Arm());
    ASSERT_EQ(d.shapes.size(), 1u);
    EXPECT_EQ(d.shapes[0].worldFromObject, Mat4d::Identity());
    // Both joints leave the middle at x = 1; the end turns around it. Weights need not sum to 1.
    ExpectNear(Positions(d), {0, 0, 3, 1, 0, 3, 1, 1, 3});
    ExpectNear(FloatsOf(d.shapes[0], ParameterType::Normal, "N"),
               {0, 1, 0, -kHalf, kHalf, 0, -1, 0, 0});
}

TEST(GltfSkins, TurnNormalsAsTheSurfaceTurns) {
    GltfFile file = Arm();
    // Flattening along x turns a normal between x and y towards x.
    file.root["nodes"][1]["scale"] = {0.5, 1, 1};
    file.root["nodes"][2].erase("rotation");
    const int n = file.Floats({1, 1, 0, 1, 1, 0, 1, 1, 0}, "VEC3");
    file.root["meshes"][0]["primitives"][0]["attributes"]["NORMAL"] = n;
    const auto normals = FloatsOf(kFolder.Parse(file).shapes.at(0), ParameterType::Normal, "N");
    EXPECT_NEAR(normals[0], 2 / std::sqrt(5.), 1e-6);
    EXPECT_NEAR(normals[1], 1 / std::sqrt(5.), 1e-6);
}

// Adds a triangle with two morph targets, of which the second has normals as well.
int Face(GltfFile* file) {
    const int p = file->Floats({0, 0, 0, 1, 0, 0, 0, 1, 0}, "VEC3");
    const int n = file->Floats({0, 0, 1, 0, 0, 1, 0, 0, 1}, "VEC3");
    const int lift = file->Floats({0, 0, 1, 0, 0, 1, 0, 0, 1}, "VEC3");
    const int stretch = file->Floats({0, 0, 0, 2, 0, 0, 0, 0, 0}, "VEC3");
    const int lean = file->Floats({1, 0, 0, 0, 0, 0, 0, 0, 0}, "VEC3");
    return file->Mesh(
        {{"POSITION", p}, {"NORMAL", n}},
        {{"targets", {{{"POSITION", lift}}, {{"POSITION", stretch}, {"NORMAL", lean}}}}});
}

TEST(GltfMorphs, AddTargetsByTheirWeights) {
    GltfFile file;
    const int mesh = Face(&file);
    file.root["meshes"][0]["weights"] = {0.5, 0};
    file.Node({{"mesh", mesh}});
    file.Node({{"mesh", mesh}, {"weights", {0, 0.25}}});
    const Description d = kFolder.ParseSilently(file);
    ASSERT_EQ(d.shapes.size(), 2u);  // different poses are no instances of one another
    ExpectNear(Positions(d, 0), {0, 0, 0, 1.5, 0, 0, 0, 1, 0});
    ExpectNear(FloatsOf(d.shapes[0], ParameterType::Normal, "N"), {0.25, 0, 1, 0, 0, 1, 0, 0, 1});
    ExpectNear(Positions(d, 1), {0, 0, 0.5, 1, 0, 0.5, 0, 1, 0.5});
}

// Moves a node's property by two keys at 1 s and 3 s.
GltfFile Animated(const char* path, const std::vector<float>& values, const char* type,
                  const char* interpolation = "LINEAR") {
    GltfFile file;
    file.Node({{"mesh", Face(&file)}});
    const int times = file.Floats({1, 3}, "SCALAR");
    file.root["animations"] = {
        {{"samplers",
          {{{"input", times},
            {"output", file.Floats(values, type)},
            {"interpolation", interpolation}}}},
         {"channels", {{{"sampler", 0}, {"target", {{"node", 0}, {"path", path}}}}}}}};
    return file;
}

Vec3f MovedPoint(const GltfFile& file, double seconds, const Vec3f& p) {
    return TransformPoint(kFolder.Parse(file, {.frame = seconds}).shapes.at(0).worldFromObject, p);
}

TEST(GltfAnimations, InterpolateAsTheirSamplersSay) {
    const std::vector<float> keys = {0, 0, 0, 4, 0, 8};
    const GltfFile linear = Animated("translation", keys, "VEC3");
    const GltfFile step = Animated("translation", keys, "VEC3", "STEP");
    for (const auto& [seconds, way] :
         {std::pair{0., 0.f}, {1., 0.f}, {1.5, 0.25f}, {3., 1.f}, {9., 1.f}}) {
        EXPECT_TRUE(MovedPoint(linear, seconds, Vec3f::Zero()).isApprox(way * Vec3f(4, 0, 8)));
        EXPECT_TRUE(MovedPoint(step, seconds, Vec3f::Zero())
                        .isApprox((way < 1 ? 0.f : 1.f) * Vec3f(4, 0, 8)));
    }
    // Hermite's spline from 0 to 4 with slopes 1 and -2 at its ends, over 2 s; at half of it the
    // mean of the ends, and an eighth of the length times the difference of the slopes.
    const GltfFile cubic = Animated("scale",
                                    {9, 9, 9, 1, 1, 1, 1, 1, 1,  //
                                     -2, -2, -2, 5, 5, 5, 9, 9, 9},
                                    "VEC3", "CUBICSPLINE");
    EXPECT_NEAR(MovedPoint(cubic, 2, Vec3f(1, 0, 0)).x(), 3 + 2 / 8. * 3, 1e-5);
    EXPECT_NEAR(MovedPoint(cubic, 0, Vec3f(1, 0, 0)).x(), 1, 1e-5);
}

TEST(GltfAnimations, TurnTheShorterWayAtEvenSpeed) {
    // From no turn to a quarter about z, given as the quaternion of the other sign.
    const GltfFile file = Animated("rotation", {0, 0, 0, 1, 0, 0, -kHalf, -kHalf}, "VEC4");
    const double angle = kPi / 2 / 4;
    EXPECT_TRUE(MovedPoint(file, 1.5, Vec3f(1, 0, 0))
                    .isApprox(Vec3f(float(std::cos(angle)), float(std::sin(angle)), 0), 1e-5f));
}

TEST(GltfAnimations, MoveWeightsJointsAndCameras) {
    const Description morphed =
        kFolder.Parse(Animated("weights", {0, 0, 1, 0.5}, "SCALAR"), {.frame = 3});
    ExpectNear(Positions(morphed), {0, 0, 1, 2, 0, 1, 0, 1, 1});

    GltfFile arm = Arm();
    const int times = arm.Floats({0, 1}, "SCALAR");
    const int turns = arm.Floats({0, 0, 0, 1, 0, 0, -kHalf, kHalf}, "VEC4");
    const json channel = {{"sampler", 0}, {"target", {{"node", 2}, {"path", "rotation"}}}};
    arm.root["animations"] = {
        {{"name", "rest"}, {"samplers", json::array()}, {"channels", json::array()}},
        {{"name", "bow"},
         {"samplers", {{{"input", times}, {"output", turns}}}},
         {"channels", {channel}}}};
    for (const char* name : {"bow", "1"})
        ExpectNear(Positions(kFolder.Parse(arm, {.frame = 1, .animation = name})),
                   {0, 0, 3, 1, 0, 3, 1, -1, 3});
    ExpectNear(Positions(kFolder.Parse(arm, {.frame = 1, .animation = "rest"})),
               {0, 0, 3, 1, 0, 3, 1, 1, 3});

    GltfFile camera = Animated("translation", {0, 0, 0, 4, 0, 8}, "VEC3");
    camera.root["cameras"] = json::array({kPerspectiveCamera});
    camera.root["nodes"][0] = {{"camera", 0}};
    const Description seen = kFolder.Parse(camera, {.frame = 2});
    EXPECT_TRUE(TransformPoint(seen.cameraFromWorld, Vec3f(2, 0, 4)).isZero(1e-5f));
}

TEST(GltfAnimations, PoseTogether) {
    GltfFile file = Animated("translation", {0, 0, 0, 4, 0, 8}, "VEC3");
    const auto add = [&](const char* path, const std::vector<float>& values) {
        json more = Animated(path, values, "VEC3").root["animations"][0];
        more["samplers"][0]["input"] = file.root["animations"][0]["samplers"][0]["input"];
        more["samplers"][0]["output"] = file.Floats(values, "VEC3");
        file.root["animations"].push_back(more);
    };
    add("scale", {1, 1, 1, 3, 3, 3});
    Warnings agreeing, contradicting;
    const auto pointOf = [&](const std::string& animation, Warnings* warnings) {
        const Description d = kFolder.Parse(file, {.frame = 3, .animation = animation}, warnings);
        return TransformPoint(d.shapes.at(0).worldFromObject, Vec3f(1, 0, 0));
    };
    EXPECT_TRUE(pointOf("", &agreeing).isApprox(Vec3f(7, 0, 8)));
    EXPECT_TRUE(pointOf("0", &agreeing).isApprox(Vec3f(5, 0, 8)));
    EXPECT_TRUE(pointOf("1", &agreeing).isApprox(Vec3f(3, 0, 0)));
    EXPECT_TRUE(agreeing.Counts().empty());
    add("translation", {0, 0, 0, 9, 9, 9});  // of what the first moves
    EXPECT_TRUE(pointOf("", &contradicting).isApprox(Vec3f(7, 0, 8)));
    EXPECT_EQ(contradicting.Counts().count(
                  "1 of 3 animations left out in part: others before them move the same; "
                  "--animation NAME|N chooses one"),
              1u);
}

TEST(GltfShutter, BlursNodesAndCamerasThatMove) {
    GltfFile file = Animated("translation", {0, 0, 0, 4, 0, 8}, "VEC3");
    file.root["cameras"] = json::array({kPerspectiveCamera});
    file.root["nodes"][0]["children"] = {1};
    file.root["nodes"].push_back({{"camera", 0}});
    file.Node({{"mesh", file.Triangle()}});
    const Description d = kFolder.ParseSilently(file, {.frame = 1.5, .shutter = 0.5});
    EXPECT_EQ(d.shapes.size(), 1u);  // what stands still
    ASSERT_EQ(d.instances.size(), 1u);
    ASSERT_EQ(d.instances[0].motion, 0);
    ASSERT_EQ(d.motions.at(0).size(), 1u);
    EXPECT_EQ(d.transformTimes, (std::array<double, 2>{0, 1}));
    const auto& [open, close] = d.motions[0][0].at;
    EXPECT_TRUE(TransformPoint(open, Vec3f::Zero()).isApprox(Vec3f(1, 0, 2)));
    EXPECT_TRUE(TransformPoint(close, Vec3f::Zero()).isApprox(Vec3f(2, 0, 4)));
    EXPECT_EQ(d.instances[0].worldFromInstance, open);
    ASSERT_TRUE(d.movingCameraFromWorld);
    EXPECT_EQ(d.movingCameraFromWorld->at[0], d.cameraFromWorld);
    EXPECT_TRUE(TransformPoint(d.movingCameraFromWorld->at[1], Vec3f(2, 0, 4)).isZero(1e-5f));

    // Before its first key, and without a shutter, it stands still.
    for (const GltfOptions& still :
         {GltfOptions{.frame = 0, .shutter = 1}, GltfOptions{.frame = 2}}) {
        const Description other = kFolder.Parse(file, still);
        EXPECT_TRUE(other.motions.empty());
        EXPECT_FALSE(other.movingCameraFromWorld);
        EXPECT_EQ(other.shapes.size(), 2u);
    }
}

TEST(GltfShutter, WarnsOfWhatItCannotBlur) {
    const auto countOf = [](const GltfFile& file, const std::string& message) {
        Warnings warnings;
        kFolder.Parse(file, {.frame = 1, .shutter = 0.5}, &warnings);
        return warnings.Counts()[message];
    };
    EXPECT_EQ(countOf(Animated("weights", {0, 0, 1, 0.5}, "SCALAR"),
                      "morph targets are not blurred by their motion"),
              1);
    GltfFile arm = Arm();
    const int times = arm.Floats({0, 2}, "SCALAR");
    const int turns = arm.Floats({0, 0, 0, 1, 0, 0, -kHalf, kHalf}, "VEC4");
    arm.root["animations"] = {
        {{"samplers", {{{"input", times}, {"output", turns}}}},
         {"channels", {{{"sampler", 0}, {"target", {{"node", 2}, {"path", "rotation"}}}}}}}};
    EXPECT_EQ(countOf(arm, "skins are not blurred by the motion of their joints"), 1);
    GltfFile lamp = Animated("translation", {0, 0, 0, 4, 0, 8}, "VEC3");
    lamp.root["materials"] = {{{"emissiveFactor", {1, 1, 1}}}};
    lamp.root["meshes"][0]["primitives"][0]["material"] = 0;
    EXPECT_EQ(countOf(lamp, "moving emitters have no motion blur"), 1);
}

TEST(GltfAnimations, AreNamedWhereTheyAreLeftOut) {
    Warnings warnings;
    const GltfFile file = Animated("translation", {0, 0, 0, 4, 0, 8}, "VEC3");
    EXPECT_EQ(kFolder.Parse(file, {}, &warnings).shapes.at(0).worldFromObject, Mat4d::Identity());
    EXPECT_EQ(
        warnings.Counts().count("the scene is shown as the file stands; --frame SECONDS poses "
                                "its animation"),
        1u);
    Warnings ofPath;
    kFolder.Parse(Animated("pointer", {0, 0, 0, 4, 0, 8}, "VEC3"), {.frame = 1}, &ofPath);
    EXPECT_EQ(ofPath.Counts().count("animation of \"pointer\" is left out"), 1u);
}

TEST(GltfPoses, RefuseWhatDoesNotFit) {
    const auto errorOf = [&](GltfFile file, const char* pointer, const json& value) {
        file.root[json::json_pointer(pointer)] = value;
        const std::string error = ErrorOf([&] { kFolder.Parse(file, {.frame = 2}); });
        const size_t at = error.find(".gltf: ");
        return at == std::string::npos ? error : error.substr(at + 7);
    };
    GltfFile arm = Arm();
    arm.root["animations"] = {{{"samplers", json::array()}, {"channels", json::array()}}};
    EXPECT_EQ(errorOf(arm, "/skins/0/joints", {1, 9}),
              "/skins/0/joints/1: is 9, but there are only 3 nodes");
    EXPECT_EQ(errorOf(arm, "/skins/0/joints", json::array({1})),
              "/meshes/0/primitives/0: vertex 1 has joint 1, but its skin has 1");
    EXPECT_EQ(errorOf(arm, "/skins/0/joints", {1, 2, 2}),
              "/skins/0: has 2 inverse bind matrices for 3 joints");
    EXPECT_EQ(errorOf(arm, "/nodes/1/children", json::array()),
              "/skins/0: its joint 1 is not in the scene");
    GltfFile bare = arm;
    bare.root["meshes"][0]["primitives"][0]["attributes"].erase("WEIGHTS_0");
    EXPECT_EQ(errorOf(bare, "/asset/generator", "test"),
              "/meshes/0/primitives/0: has a skin, but no JOINTS_0 and WEIGHTS_0");

    const GltfFile moved = Animated("weights", {0, 0, 1, 1}, "SCALAR");
    EXPECT_EQ(errorOf(moved, "/animations/0/channels/0/sampler", 3),
              "/animations/0/channels/0/sampler: there are only 1 samplers");
    EXPECT_EQ(errorOf(moved, "/animations/0/samplers/0/output", 99),
              "/animations/0/samplers/0/output: is 99, but there are only 7 accessors");
    EXPECT_EQ(errorOf(moved, "/animations/0/samplers/0/interpolation", "FAST"),
              "/animations/0/samplers/0/interpolation: is \"FAST\", which is not defined");
    EXPECT_EQ(errorOf(moved, "/accessors/6/count", 3),
              "/accessors/6: its 3 numbers do not fit 2 keys");
    EXPECT_EQ(errorOf(moved, "/animations/0/channels/0/target/path", "scale"),
              "/accessors/6: has to have 3 components for its use");
    EXPECT_EQ(errorOf(moved, "/meshes/0/primitives/0/targets", json::array()),
              "/meshes/0/primitives/0: has 0 morph targets for 2 weights");
    // Keys may be rounded to the same time.
    GltfFile timed = moved;
    const size_t first = timed.root["bufferViews"][5]["byteOffset"];
    std::memcpy(&timed.bytes[first + 4], &timed.bytes[first], 4);
    EXPECT_EQ(errorOf(timed, "/asset/generator", "test"), "");
    const float earlier = 0.5f;
    std::memcpy(&timed.bytes[first + 4], &earlier, 4);
    EXPECT_EQ(errorOf(timed, "/asset/generator", "test"),
              "/accessors/5: key 1 is earlier than the one before");
    EXPECT_EQ(errorOf(Arm(), "/asset/generator", "test"), "has no animation to pose");
}

}  // namespace
}  // namespace lull::gltf_poses_test
