// Checks nodes and cameras of glTF files, and edits of scenes.
#include "renderer/input/scene_edits.h"
#include "tests/renderer/input/gltf_files.h"

namespace lull::gltf_nodes_test {
namespace {

TEST(GltfNodes, KeepTheNamesOfItsNodes) {
    GltfFile file;
    const int plain = file.Triangle(), twice = file.Triangle();
    file.root["meshes"][0]["name"] = "sheet";
    file.root["meshes"][1]["name"] = "chair";
    file.Node({{"mesh", plain}, {"name", "paper"}});
    for (const float x : {0.f, 2.f}) file.Node({{"mesh", twice}, {"translation", {x, 0.f, 0.f}}});
    const Description d = kFolder.Parse(file);
    ASSERT_EQ(d.shapes.size(), 1u);
    EXPECT_EQ(d.shapes[0].label, "paper");
    ASSERT_EQ(d.objects.size(), 1u);
    EXPECT_EQ(d.objects[0].name, "chair");

    GltfFile unnamed = OneTriangle();
    unnamed.root["meshes"][0]["name"] = "sheet";
    EXPECT_EQ(kFolder.Parse(unnamed).shapes.at(0).label, "sheet");
}

TEST(GltfNodes, MultiplyAlongTheHierarchy) {
    GltfFile file;
    const float half = std::sqrt(0.5f);
    file.Node({{"translation", {1, 2, 3}},
               {"rotation", {0, 0, half, half}},  // a quarter turn about z
               {"scale", {2, 2, 2}},
               {"children", {1}}});
    file.root["nodes"].push_back(
        {{"mesh", file.Triangle()}, {"matrix", {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 5, 0, 0, 1}}});
    const Description d = kFolder.Parse(file);
    ASSERT_EQ(d.shapes.size(), 1u);
    // (1, 0, 0) to (6, 0, 0) to (12, 0, 0) to (0, 12, 0) to (1, 14, 3).
    EXPECT_TRUE(
        TransformPoint(d.shapes[0].worldFromObject, {1, 0, 0}).isApprox(Vec3f(1, 14, 3), 1e-5f));
}

TEST(GltfNodes, ShareMeshesAsInstances) {
    GltfFile file;
    const int mesh = file.Triangle();
    file.Node({{"mesh", mesh}});
    file.Node({{"mesh", mesh}, {"translation", {0, 0, 4}}});
    const Description d = kFolder.Parse(file);
    EXPECT_TRUE(d.shapes.empty());
    ASSERT_EQ(d.objects.size(), 1u);
    ASSERT_EQ(d.instances.size(), 2u);
    EXPECT_EQ(d.instances[1].worldFromInstance(2, 3), 4);
}

// Meshes and lights below an invisible node are left out; cameras are not.
TEST(GltfNodes, HideWhatIsBelowInvisibleOnes) {
    const auto visibility = [](bool visible) {
        return json{{"KHR_node_visibility", {{"visible", visible}}}};
    };
    GltfFile file;
    const int mesh = file.Triangle();
    json lamp = visibility(true);
    lamp["KHR_lights_punctual"] = {{"light", 0}};
    file.root["extensions"] = {{"KHR_lights_punctual", {{"lights", {{{"type", "point"}}}}}}};
    file.root["extensionsRequired"] = {"KHR_node_visibility"};
    file.root["cameras"] = json::array({kPerspectiveCamera});
    file.root["nodes"] = {{{"extensions", visibility(false)}, {"children", {1, 2, 3}}},
                          {{"mesh", mesh}, {"extensions", visibility(true)}},
                          {{"extensions", lamp}},
                          {{"camera", 0}, {"translation", {0, 0, 7}}}};
    const Description hidden = kFolder.ParseSilently(file);
    EXPECT_TRUE(hidden.shapes.empty());
    EXPECT_TRUE(hidden.lights.empty());
    EXPECT_EQ(hidden.camera.name, "perspective");
    file.root["nodes"][0]["extensions"] = visibility(true);
    const Description shown = kFolder.Parse(file);
    EXPECT_EQ(shown.shapes.size(), 1u);
    EXPECT_EQ(shown.lights.size(), 1u);
    file.root["nodes"][0]["extensions"]["KHR_node_visibility"]["visible"] = 0;
    EXPECT_EQ(kFolder.ErrorOf(file),
              "scene.gltf: /nodes/0/extensions/KHR_node_visibility/visible: has to be true or "
              "false");
}

TEST(GltfNodes, CopyWhatEmitsInsteadOfInstancing) {
    GltfFile file;
    file.root["materials"] = {{{"emissiveFactor", {1, 0.5, 0}}}};
    const int mesh = file.Triangle({{"material", 0}});
    file.Node({{"mesh", mesh}});
    file.Node({{"mesh", mesh}});
    const Description d = kFolder.Parse(file);
    EXPECT_EQ(d.shapes.size(), 2u);
    EXPECT_TRUE(d.instances.empty());
    ASSERT_TRUE(d.shapes[1].areaLight);
    EXPECT_TRUE(
        (d.shapes[1].areaLight->parameters.GetSpectrum("L", Rgb::Zero()) == Rgb(1, 0.5f, 0)).all());
}

TEST(GltfNodes, PlaceCopiesByTheExtension) {
    GltfFile file;
    const int translation = file.Floats({0, 0, 0, 0, 1, 0, 0, 2, 0}, "VEC3");
    const int scale = file.Floats({1, 1, 1, 2, 2, 2, 3, 3, 3}, "VEC3");
    file.Node({{"mesh", file.Triangle()},
               {"extensions",
                {{"EXT_mesh_gpu_instancing",
                  {{"attributes", {{"TRANSLATION", translation}, {"SCALE", scale}}}}}}}});
    file.root["extensionsRequired"] = {"EXT_mesh_gpu_instancing"};
    const Description d = kFolder.Parse(file);
    ASSERT_EQ(d.instances.size(), 3u);
    EXPECT_TRUE(
        TransformPoint(d.instances[2].worldFromInstance, {1, 0, 0}).isApprox(Vec3f(3, 2, 0)));
}

TEST(GltfNodes, CountCopiesByAttributesOfAnyName) {
    GltfFile file;
    const int id = file.Floats({7, 8}, "SCALAR");
    file.Node({{"mesh", file.Triangle()},
               {"extensions", {{"EXT_mesh_gpu_instancing", {{"attributes", {{"_ID", id}}}}}}}});
    EXPECT_EQ(kFolder.Parse(file).instances.size(), 2u);
}

GltfFile WithCameras() {
    GltfFile file;
    file.Node({{"mesh", file.Triangle()}});
    file.root["cameras"] = {
        {{"type", "perspective"},
         {"perspective", {{"yfov", 0.8}, {"aspectRatio", 2}, {"znear", 0.1}}}},
        {{"type", "orthographic"},
         {"name", "plan"},
         {"orthographic", {{"xmag", 3}, {"ymag", 4}, {"znear", 0}, {"zfar", 10}}}}};
    file.Node({{"camera", 0}, {"translation", {0, 0, 5}}, {"scale", {2, 2, 2}}});
    file.Node({{"camera", 1}, {"name", "above"}});
    return file;
}

TEST(GltfCameras, LookAlongTheirNodes) {
    const Description d = kFolder.Parse(WithCameras());
    EXPECT_EQ(d.camera.name, "perspective");
    const float tangent = std::tan(0.4f);
    ExpectNear(FloatsOf(d.camera, ParameterType::Float, "screenfit"), {2 * tangent, tangent},
               1e-6f);
    EXPECT_EQ(d.film.parameters.GetInt("xresolution", 0), 1600);
    EXPECT_EQ(d.film.parameters.GetInt("yresolution", 0), 800);
    // The origin lies 5 ahead; x is to the right and y upwards.
    EXPECT_TRUE(TransformPoint(d.cameraFromWorld, {1, 2, 0}).isApprox(Vec3f(1, 2, 5)));
}

TEST(GltfCameras, AreChosenByNameOrNumber) {
    for (const char* name : {"1", "plan", "above"}) {
        const Description d = kFolder.Parse(WithCameras(), {.camera = name});
        EXPECT_EQ(d.camera.name, "orthographic") << name;
        ExpectNear(FloatsOf(d.camera, ParameterType::Float, "screenfit"), {3, 4}, 0);
        EXPECT_EQ(d.film.parameters.GetInt("xresolution", 0), 600);
    }
    const std::string error = ErrorOf([&] { kFolder.Parse(WithCameras(), {.camera = "2"}); });
    EXPECT_HAS(error, "has no camera \"2\"; it has 0 \"\", 1 \"above\"");
}

TEST(GltfCameras, FrameTheWholeScene) {
    GltfFile file;
    file.Node({{"mesh", file.Triangle()}, {"scale", {1, 3, 1}}});
    for (const float azimuth : {0.f, 180.f}) {
        const Description d = kFolder.Parse(file, {.orbit = std::array{azimuth, 0.f}});
        // Seen from the front and the back; upright, it fills the height but for 6 % at each end.
        const double edge = 0.88 * std::tan(20 * kPi / 180);
        const Vec3f top = TransformPoint(d.cameraFromWorld, {0, 3, 0});
        const Vec3f bottom = TransformPoint(d.cameraFromWorld, {0, 0, 0});
        EXPECT_NEAR(top.y() / top.z(), edge, 1e-5);
        EXPECT_NEAR(bottom.y() / bottom.z(), -edge, 1e-5);
        // It stands in the middle.
        const Vec3f right = TransformPoint(d.cameraFromWorld, {1, 0, 0});
        EXPECT_NEAR(right.x() + bottom.x(), 0, 1e-5);
        EXPECT_NEAR(right.x() - bottom.x(), azimuth == 0 ? 1 : -1, 1e-5);
    }
}

// Whatever the direction, everything is in the picture, and something is near its edge.
TEST(GltfCameras, FillThePictureFromAnywhere) {
    std::vector<float> points;
    for (int i = 0; i < 500; ++i)
        for (const double c : {std::cos(i), std::sin(3 * i) + 5, 0.2 * std::cos(7 * i)})
            points.push_back(float(c));
    GltfFile file;
    file.Node({{"mesh", file.Mesh({{"POSITION", file.Floats(points, "VEC3")}})}});
    for (const float azimuth : {0.f, 50.f, 200.f})
        for (const float elevation : {-90.f, 0.f, 33.f, 90.f}) {
            const Description d = kFolder.Parse(file, {.orbit = std::array{azimuth, elevation}});
            double most = 0;
            for (size_t i = 0; i < points.size(); i += 3) {
                const Vec3f p =
                    TransformPoint(d.cameraFromWorld, {points[i], points[i + 1], points[i + 2]});
                ASSERT_GT(p.z(), 0);
                const double half = std::tan(20 * kPi / 180) * double(p.z());
                most = std::max({most, std::abs(p.x()) / (1.5 * half), std::abs(p.y()) / half});
            }
            EXPECT_LT(most, 0.95) << azimuth << " " << elevation;
            EXPECT_GT(most, 0.85) << azimuth << " " << elevation;
        }
}

TEST(GltfCameras, HaveLensesOfOurOwn) {
    GltfFile file = WithCameras();
    file.root["cameras"][0]["extras"] = {{"lull",
                                          {{"shift", {0.25, -0.5}},
                                           {"lensRadius", 0.125},
                                           {"focusDistance", 3},
                                           {"clipStart", 2},
                                           {"clipEnd", 9}}}};
    const Parameters camera = kFolder.Parse(file).camera.parameters;
    ExpectNear(FloatsOf(kFolder.Parse(file).camera, ParameterType::Float, "screenshift"),
               {0.25f, -0.5f}, 0);
    EXPECT_EQ(camera.GetFloat("lensradius", 0), 0.125f);
    EXPECT_EQ(camera.GetFloat("focaldistance", 0), 3);
    EXPECT_EQ(camera.GetFloat("clipstart", 0), 2);
    EXPECT_EQ(camera.GetFloat("clipend", 0), 9);
    file.root["cameras"][0]["extras"] = {{"lull", {{"shift", 1}}}};
    EXPECT_EQ(kFolder.ErrorOf(file),
              "scene.gltf: /cameras/0/extras/lull/shift: has to be an array of 2 numbers");
    file.root["cameras"][0]["extras"] = {{"somebody", "else's"}};
    EXPECT_EQ(kFolder.ErrorOf(file), "");
}

TEST(GltfNodes, MatricesAreAffineUpToRounding) {
    GltfFile file;
    file.Node({{"mesh", file.Triangle()},
               {"matrix", {1, 0, 0, 1e-9, 0, 1, 0, 0, 0, 0, 1, 0, 3, 0, 0, 0.99999994}}});
    const Description d = kFolder.Parse(file);
    EXPECT_EQ(d.shapes.at(0).worldFromObject.row(3), Eigen::RowVector4d(0, 0, 0, 1));
    file.root["nodes"][0]["matrix"][15] = 0.999;
    EXPECT_HAS(kFolder.ErrorOf(file), "is not affine");
}

TEST(SceneEdits, LightOnlyWhatIsDark) {
    Description d = kFolder.Parse(OneTriangle());
    Warnings warnings;
    LightIfDark(&d, warnings);
    ASSERT_EQ(d.lights.size(), 1u);
    EXPECT_EQ(d.lights[0].name, "infinite");
    EXPECT_TRUE(d.lights[0].parameters.GetBool("studio", false));
    // Its x axis points to the camera, its y axis to the right in the picture, its z axis up.
    const Mat4d& m = d.lights[0].worldFromLight;
    const auto seen = [&](const Vec3f& axis) {
        return TransformVector(d.cameraFromWorld, TransformVector(m, axis));
    };
    EXPECT_LT(seen(Vec3f::UnitX()).z(), -0.9f);
    EXPECT_GT(seen(Vec3f::UnitY()).x(), 0.99f);
    EXPECT_TRUE(TransformVector(m, Vec3f::UnitZ()).isApprox(Vec3f::UnitY()));
    LightIfDark(&d, warnings);
    EXPECT_EQ(d.lights.size(), 1u);
    EXPECT_EQ(warnings.Total(), 1);
}

TEST(SceneEdits, TurnEnvironmentsUpright) {
    Description d = kFolder.Parse(OneTriangle(), {.orbit = std::array{10.f, 20.f}});
    SetEnvironment("sky.exr", 0, &d);
    SetEnvironment("sky.exr", 90, &d);  // replaces the first
    ASSERT_EQ(d.lights.size(), 1u);
    const Mat4d& m = d.lights[0].worldFromLight;
    EXPECT_TRUE(TransformVector(m, Vec3f::UnitZ()).isApprox(Vec3f::UnitY()));
    EXPECT_LT(m.determinant(), 0);  // the world is right-handed
    // The file's format says where up is, not the camera, which may look down.
    Description above = kFolder.Parse(OneTriangle(), {.orbit = std::array{10.f, 90.f}});
    SetEnvironment("sky.exr", 90, &above);
    EXPECT_TRUE(above.lights[0].worldFromLight.isApprox(m));
    // A quarter turn, counterclockwise as seen from above, from where Blender has the image's edge.
    EXPECT_TRUE(TransformVector(m, Vec3f::UnitX()).isApprox(Vec3f::UnitZ()));
}

}  // namespace
}  // namespace lull::gltf_nodes_test
