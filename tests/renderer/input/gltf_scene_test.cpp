// Checks nodes, cameras, lights and materials of glTF files.
#include "renderer/input/scene_edits.h"
#include "tests/renderer/input/gltf_files.h"

namespace lull {
namespace {

const GltfFolder kFolder;

Vec3f Transformed(const Mat4d& m, const Vec3f& p) { return TransformPoint(m, p); }

TEST(GltfNodes, KeepTheNamesOfItsNodes) {
    GltfFile file;
    const int plain = file.Triangle(), twice = file.Triangle();
    file.root["meshes"][0]["name"] = "sheet";
    file.root["meshes"][1]["name"] = "chair";
    file.Node({{"mesh", plain}, {"name", "paper"}});
    for (const float x : {0.f, 2.f}) file.Node({{"mesh", twice}, {"translation", {x, 0.f, 0.f}}});
    const Description d = GltfFolder().Parse(file);
    ASSERT_EQ(d.shapes.size(), 1u);
    EXPECT_EQ(d.shapes[0].label, "paper");
    ASSERT_EQ(d.objects.size(), 1u);
    EXPECT_EQ(d.objects[0].name, "chair");

    GltfFile unnamed;
    unnamed.Node({{"mesh", unnamed.Triangle()}});
    unnamed.root["meshes"][0]["name"] = "sheet";
    EXPECT_EQ(GltfFolder().Parse(unnamed).shapes.at(0).label, "sheet");
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
        Transformed(d.shapes[0].worldFromObject, {1, 0, 0}).isApprox(Vec3f(1, 14, 3), 1e-5f));
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
    EXPECT_TRUE(Transformed(d.instances[2].worldFromInstance, {1, 0, 0}).isApprox(Vec3f(3, 2, 0)));
}

TEST(GltfNodes, LeaveOutWhatIsScaledToNothing) {
    GltfFile file;
    file.Node({{"mesh", file.Triangle()}, {"scale", {1, 0, 1}}});
    Warnings warnings;
    EXPECT_TRUE(kFolder.Parse(file, {}, &warnings).shapes.empty());
    EXPECT_EQ(warnings.Total(), 1);
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
    EXPECT_TRUE(Transformed(d.cameraFromWorld, {1, 2, 0}).isApprox(Vec3f(1, 2, 5)));
}

TEST(GltfCameras, AreChosenByNameOrNumber) {
    for (const char* name : {"1", "plan", "above"}) {
        const Description d = kFolder.Parse(WithCameras(), {.camera = name});
        EXPECT_EQ(d.camera.name, "orthographic") << name;
        ExpectNear(FloatsOf(d.camera, ParameterType::Float, "screenfit"), {3, 4}, 0);
        EXPECT_EQ(d.film.parameters.GetInt("xresolution", 0), 600);
    }
    const std::string error = ErrorOf([&] { kFolder.Parse(WithCameras(), {.camera = "2"}); });
    EXPECT_NE(error.find("has no camera \"2\"; it has 0 \"\", 1 \"above\""), std::string::npos)
        << error;
}

TEST(GltfCameras, FrameTheWholeScene) {
    GltfFile file;
    file.Node({{"mesh", file.Triangle()}, {"scale", {1, 3, 1}}});
    for (const float azimuth : {0.f, 180.f}) {
        const Description d = kFolder.Parse(file, {.orbit = std::array{azimuth, 0.f}});
        // Seen from the front and the back; upright, it fills the height but for 6 % at each end.
        const double edge = 0.88 * std::tan(20 * kPi / 180);
        const Vec3f top = Transformed(d.cameraFromWorld, {0, 3, 0});
        const Vec3f bottom = Transformed(d.cameraFromWorld, {0, 0, 0});
        EXPECT_NEAR(top.y() / top.z(), edge, 1e-5);
        EXPECT_NEAR(bottom.y() / bottom.z(), -edge, 1e-5);
        // It stands in the middle.
        const Vec3f right = Transformed(d.cameraFromWorld, {1, 0, 0});
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
                    Transformed(d.cameraFromWorld, {points[i], points[i + 1], points[i + 2]});
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

TEST(GltfLights, AreTakenFromPhotometricUnits) {
    GltfFile file;
    file.root["extensions"] = {
        {"KHR_lights_punctual",
         {{"lights",
           {{{"type", "point"}, {"intensity", 683}, {"color", {1, 0.5, 0}}},
            {{"type", "directional"}, {"intensity", 1366}},
            {{"type", "spot"}, {"spot", {{"innerConeAngle", 0.2}, {"outerConeAngle", 0.5}}}}}}}}};
    for (int i = 0; i < 3; ++i)
        file.Node(
            {{"extensions", {{"KHR_lights_punctual", {{"light", i}}}}}, {"scale", {3, 3, 3}}});
    const Description d = kFolder.Parse(file);
    ASSERT_EQ(d.lights.size(), 3u);
    EXPECT_TRUE(d.lights[0].parameters.GetSpectrum("I", Rgb::Zero()).isApprox(Rgb(1, 0.5f, 0)));
    EXPECT_EQ(d.lights[1].name, "distant");
    EXPECT_TRUE(d.lights[1].parameters.GetSpectrum("L", Rgb::Zero()).isApprox(Rgb(2, 2, 2)));
    EXPECT_EQ(d.lights[2].name, "spot-squared");
    EXPECT_NEAR(d.lights[2].parameters.GetFloat("coneangle", 0), 0.5 * 180 / kPi, 1e-4);
    EXPECT_NEAR(d.lights[2].parameters.GetFloat("conedeltaangle", 0), 0.3 * 180 / kPi, 1e-4);
}

// What exporters write for cones with sharp edges, and up to half of the sphere.
TEST(GltfLights, HaveConesUpToRounding) {
    const auto cone = [](const json& spot) {
        GltfFile file;
        file.root["extensions"] = {
            {"KHR_lights_punctual", {{"lights", {{{"type", "spot"}, {"spot", spot}}}}}}};
        file.Node({{"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}});
        return file;
    };
    const auto angles = [&](double inner, double outer) {
        const json spot = {{"innerConeAngle", inner}, {"outerConeAngle", outer}};
        const Parameters light = kFolder.Parse(cone(spot)).lights.at(0).parameters;
        return std::pair(light.GetFloat("coneangle", 0), light.GetFloat("conedeltaangle", -1));
    };
    EXPECT_EQ(angles(0, double(1.57079637f)), std::pair(90.f, 90.f));
    EXPECT_EQ(angles(0, 1.5708), std::pair(90.f, 90.f));  // with six digits
    EXPECT_EQ(angles(0.5, 0.5).second, 0);
    EXPECT_EQ(angles(0.7, double(0.7f)).second, 0);
    EXPECT_EQ(angles(-1e-9, 0.5).second, angles(0, 0.5).second);
    for (const auto& [inner, outer] : {std::pair(0., 1.58), {0.6, 0.5}, {-0.1, 0.5}, {0., 0.}})
        EXPECT_NE(kFolder.ErrorOf(cone({{"innerConeAngle", inner}, {"outerConeAngle", outer}}))
                      .find("the cone's angles are"),
                  std::string::npos)
            << inner << " " << outer;
}

TEST(GltfNodes, MatricesAreAffineUpToRounding) {
    GltfFile file;
    file.Node({{"mesh", file.Triangle()},
               {"matrix", {1, 0, 0, 1e-9, 0, 1, 0, 0, 0, 0, 1, 0, 3, 0, 0, 0.99999994}}});
    const Description d = kFolder.Parse(file);
    EXPECT_EQ(d.shapes.at(0).worldFromObject.row(3), Eigen::RowVector4d(0, 0, 0, 1));
    file.root["nodes"][0]["matrix"][15] = 0.999;
    EXPECT_NE(kFolder.ErrorOf(file).find("is not affine"), std::string::npos);
}

TEST(GltfMaterials, HaveFactorsUpToRounding) {
    GltfFile file;
    const auto material = [&](const json& extensions) {
        file.root["materials"] = {{{"extensions", extensions}}};
        file.root["meshes"][0]["primitives"][0]["material"] = 0;
        return kFolder.ErrorOf(file);
    };
    file.Node({{"mesh", file.Triangle()}});
    const double above = 1.0000001192;  // the float after 1
    EXPECT_EQ(material({{"KHR_materials_sheen", {{"sheenColorFactor", {above, 1, 0}}}}}), "");
    EXPECT_EQ(material({{"KHR_materials_anisotropy", {{"anisotropyStrength", above}}}}), "");
    EXPECT_EQ(material({{"KHR_materials_volume", {{"attenuationColor", {above, -1e-9, 0}}}}}), "");
    EXPECT_NE(material({{"KHR_materials_sheen", {{"sheenColorFactor", {1.01, 1, 0}}}}}), "");
}

TEST(GltfLights, AreSpheresWithARadiusOfOurOwn) {
    GltfFile file;
    file.Node({{"mesh", file.Triangle()}});
    file.root["extensionsUsed"] = {"KHR_lights_punctual"};
    file.root["extensions"] = {
        {"KHR_lights_punctual",
         {{"lights",
           {{{"type", "point"}, {"intensity", 683}, {"extras", {{"lull", {{"radius", 0.5}}}}}},
            {{"type", "point"}, {"extras", {{"lull", {{"radius", 0}}}}}}}}}}};
    for (int i = 0; i < 2; ++i)
        file.Node({{"extensions", {{"KHR_lights_punctual", {{"light", i}}}}},
                   {"translation", {1, 2, 3}},
                   {"scale", {3, 3, 3}}});
    const Description d = kFolder.Parse(file);
    EXPECT_EQ(d.lights.size(), 1u);
    ASSERT_EQ(d.shapes.size(), 2u);
    const ShapeEntity& sphere = d.shapes[1];
    EXPECT_EQ(sphere.name, "sphere");
    EXPECT_EQ(sphere.parameters.GetFloat("radius", 0), 0.5f);
    EXPECT_TRUE(Transformed(sphere.worldFromObject, {0, 0.5f, 0}).isApprox(Vec3f(1, 2.5f, 3)));
    ASSERT_TRUE(sphere.areaLight);
    // A watt per steradian, seen as a disk of that radius.
    EXPECT_TRUE(sphere.areaLight->parameters.GetSpectrum("L", Rgb::Zero())
                    .isApprox(Rgb::Constant(4 / kPi)));
}

TEST(GltfLights, HaveAnAngleOfOurOwn) {
    GltfFile file;
    file.Node({{"mesh", file.Triangle()}});
    file.root["extensionsUsed"] = {"KHR_lights_punctual"};
    const auto parse = [&](double angle) {
        file.root["extensions"] = {
            {"KHR_lights_punctual",
             {{"lights",
               {{{"type", "directional"}, {"extras", {{"lull", {{"angle", angle}}}}}}}}}}};
        return kFolder.Parse(file);
    };
    file.Node({{"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}});
    const Description d = parse(double(kPi) / 180);
    ASSERT_EQ(d.lights.size(), 1u);
    EXPECT_NEAR(d.lights[0].parameters.GetFloat("angle", 0), 1, 1e-6);
    EXPECT_EQ(parse(0).lights[0].parameters.GetFloat("angle", -1), -1);
    EXPECT_TRUE(Contains(ErrorOf([&] { parse(-1); }), "its angle is -1"));
}

TEST(GltfLights, AreNamedByTheNodeOrTheLight) {
    GltfFile file;
    file.root["extensionsUsed"] = {"KHR_lights_punctual"};
    file.root["extensions"] = {
        {"KHR_lights_punctual",
         {{"lights",
           {{{"type", "point"}, {"name", "bulb"}},
            {{"type", "point"}, {"name", "ball"}, {"extras", {{"lull", {{"radius", 0.5}}}}}}}}}}};
    file.Node({{"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}});
    file.Node({{"name", "lamp"}, {"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}});
    file.Node({{"extensions", {{"KHR_lights_punctual", {{"light", 1}}}}}});
    const Description d = kFolder.Parse(file);
    ASSERT_EQ(d.lights.size(), 2u);
    EXPECT_EQ(d.lights[0].label, "bulb");
    EXPECT_EQ(d.lights[1].label, "lamp");
    ASSERT_EQ(d.shapes.size(), 1u);
    EXPECT_EQ(d.shapes[0].label, "ball");
}

TEST(GltfMaterials, MayAddTheInterfaceToTheBase) {
    GltfFile file;
    file.Node({{"mesh", file.Triangle({{"material", 0}})}});
    const auto adds = [&](const nlohmann::json& value) {
        file.root["materials"] = {{{"extras", {{"lull", {{"addedInterface", value}}}}}}};
        return kFolder.Parse(file).materials.at(0).parameters.GetBool("addedinterface", false);
    };
    EXPECT_TRUE(adds(true));
    EXPECT_FALSE(adds(false));
    file.root["materials"][0]["extras"]["lull"]["addedInterface"] = 1;
    EXPECT_EQ(kFolder.ErrorOf(file),
              "scene.gltf: /materials/0/extras/lull/addedInterface: has to be true or false");
}

TEST(GltfMaterials, CarryFactorsTexturesAndExtensions) {
    GltfFile file;
    file.root["images"] = {{{"uri", "a%20b.png"}}};
    file.root["samplers"] = {{{"wrapS", 33648}, {"wrapT", 33071}, {"magFilter", 9728}}};
    file.root["textures"] = {{{"source", 0}, {"sampler", 0}}};
    file.root["materials"] = {
        {{"pbrMetallicRoughness",
          {{"baseColorFactor", {0.1, 0.2, 0.3, 0.4}},
           {"baseColorTexture",
            {{"index", 0},
             {"texCoord", 1},
             {"extensions", {{"KHR_texture_transform", {{"offset", {0.25, 0.5}}}}}}}},
           {"metallicFactor", 0}}},
         {"alphaMode", "MASK"},
         {"alphaCutoff", 0.25},
         {"extensions",
          {{"KHR_materials_ior", {{"ior", 1.3}}},
           {"KHR_materials_transmission", {{"transmissionFactor", 0.75}}}}}}};
    file.root["extensionsUsed"] = {"KHR_materials_ior", "KHR_materials_iridescence"};
    file.Node({{"mesh", file.Triangle({{"material", 0}})}});
    Warnings warnings;
    const Description d = kFolder.Parse(file, {}, &warnings);
    // Of iridescence, of a sheet that transmits, and of how both textures are filtered.
    EXPECT_EQ(warnings.Total(), 4);
    ASSERT_EQ(d.materials.size(), 1u);
    const Parameters& m = d.materials[0].parameters;
    EXPECT_EQ(d.materials[0].name, "metallicroughness");
    EXPECT_TRUE(m.GetSpectrum("basecolorfactor", Rgb::Zero()).isApprox(Rgb(0.1f, 0.2f, 0.3f)));
    EXPECT_EQ(m.GetInt("basecoloruv", 0), 1);
    EXPECT_EQ(m.GetFloat("metallicfactor", 1), 0);
    EXPECT_NEAR(m.GetFloat("ior", 0), 1.3, 1e-6);
    EXPECT_NEAR(m.GetFloat("transmissionfactor", 0), 0.75, 1e-6);
    ASSERT_EQ(d.textures.size(), 2u);  // its colours and its alpha
    const TextureEntity& texture = d.textures[0];
    EXPECT_EQ(texture.parameters.GetString("filename", ""), "a b.png");
    EXPECT_EQ(texture.parameters.GetString("wrap", ""), "mirrored");
    EXPECT_EQ(texture.parameters.GetString("wrapt", ""), "clamp");
    // v turned round twice: a shift downwards by a half.
    ExpectNear(FloatsOf(texture, ParameterType::Float, "uvtransform"), {1, 0, 0.25f, 0, 1, -0.5f},
               0);
    EXPECT_NEAR(d.shapes[0].parameters.GetFloat("coveragefactor", 0), 0.4, 1e-6);
    EXPECT_NEAR(d.shapes[0].parameters.GetFloat("alphacutoff", 0), 0.25, 1e-6);
    EXPECT_EQ(d.textures[1].parameters.GetString("channel", ""), "alpha");
}

TEST(GltfMaterials, AreSolidByVolumeOrByWish) {
    for (const double thickness : {0., 0.5})
        for (const bool wish : {false, true}) {
            GltfFile file;
            file.root["materials"] = {
                {{"extensions",
                  {{"KHR_materials_transmission", {{"transmissionFactor", 1}}},
                   {"KHR_materials_volume", {{"thicknessFactor", thickness}}}}}}};
            file.Node({{"mesh", file.Triangle({{"material", 0}})}});
            Warnings warnings;
            const Description d = kFolder.Parse(file, {.solidGlass = wish}, &warnings);
            const bool isSolid = thickness > 0 || wish;
            EXPECT_EQ(d.materials.at(0).parameters.GetBool("solid", false), isSolid);
            EXPECT_EQ(warnings.Total(), isSolid ? 0 : 1);
        }
}

// A tenth of the light is left after half a unit; blue passes, green does not.
TEST(GltfMaterials, AbsorbInTheirVolume) {
    GltfFile file;
    file.root["materials"] = {{{"extensions",
                                {{"KHR_materials_transmission", {{"transmissionFactor", 1}}},
                                 {"KHR_materials_volume",
                                  {{"thicknessFactor", 1},
                                   {"attenuationDistance", 0.5},
                                   {"attenuationColor", {0.1, 0, 1}}}}}}}};
    file.root["extensionsRequired"] = {"KHR_materials_volume"};
    file.Node({{"mesh", file.Triangle({{"material", 0}})}});
    Warnings warnings;
    const Description d = kFolder.Parse(file, {}, &warnings);
    EXPECT_EQ(warnings.Total(), 0);
    ASSERT_EQ(d.media.size(), 1u);
    const Rgb absorption = d.media[0].parameters.GetSpectrum("sigma_a", Rgb::Zero());
    EXPECT_NEAR(absorption.x(), 2 * std::log(10), 1e-5);
    EXPECT_GT(absorption.y(), 1e20f);
    EXPECT_EQ(absorption.z(), 0);
    EXPECT_TRUE(IsBlack(d.media[0].parameters.GetSpectrum("sigma_s", Rgb::Ones())));
    EXPECT_EQ(d.shapes.at(0).insideMedium, 0);
    EXPECT_EQ(d.shapes.at(0).outsideMedium, -1);
    EXPECT_TRUE(IntegratorSeesMedia(d.integrator.name));

    // A sheet has no inside, what is opaque or clear no need of one.
    const auto& material = json::json_pointer("/materials/0/extensions");
    for (const json& change :
         {json{{"KHR_materials_volume", {{"thicknessFactor", 0}}}},
          json{{"KHR_materials_transmission", {{"transmissionFactor", 0}}}},
          json{{"KHR_materials_volume", {{"attenuationColor", {1, 1, 1}}}}},
          json{{"KHR_materials_volume", {{"attenuationDistance", nullptr}}}}}) {
        GltfFile other = file;
        other.root[material].merge_patch(change);
        const Description none = kFolder.Parse(other);
        EXPECT_TRUE(none.media.empty()) << change;
        EXPECT_EQ(none.shapes.at(0).insideMedium, -1);
        EXPECT_EQ(none.integrator.name, "path");
    }
}

TEST(GltfMaterials, CarrySheenAndAnisotropy) {
    GltfFile file;
    file.root["images"] = {{{"uri", "a.png"}}};
    file.root["textures"] = {{{"source", 0}}};
    file.root["materials"] = {{{"extensions",
                                {{"KHR_materials_sheen",
                                  {{"sheenColorFactor", {0.5, 0.25, 1}},
                                   {"sheenRoughnessFactor", 0.75},
                                   {"sheenRoughnessTexture", {{"index", 0}}}}},
                                 {"KHR_materials_anisotropy",
                                  {{"anisotropyStrength", 0.5},
                                   {"anisotropyRotation", 1.5},
                                   {"anisotropyTexture", {{"index", 0}, {"texCoord", 1}}}}}}}}};
    file.root["extensionsRequired"] = {"KHR_materials_sheen", "KHR_materials_anisotropy"};
    const int p = file.Floats({0, 0, 0, 1, 0, 0, 0, 1, 0}, "VEC3");
    const int n = file.Floats({0, 0, 1, 0, 0, 1, 0, 0, 1}, "VEC3");
    const int uv = file.Floats({0, 0, 0, 1, 1, 0}, "VEC2");
    file.Node({{"mesh", file.Mesh({{"POSITION", p}, {"NORMAL", n}, {"TEXCOORD_1", uv}},
                                  {{"material", 0}})}});
    const Description d = kFolder.Parse(file);
    const Parameters& m = d.materials.at(0).parameters;
    EXPECT_TRUE(m.GetSpectrum("sheencolorfactor", Rgb::Zero()).isApprox(Rgb(0.5f, 0.25f, 1)));
    EXPECT_EQ(m.GetFloat("sheenroughnessfactor", 0), 0.75f);
    EXPECT_EQ(m.GetFloat("anisotropyfactor", 0), 0.5f);
    EXPECT_EQ(m.GetFloat("anisotropyrotation", 0), 1.5f);
    EXPECT_EQ(m.GetInt("anisotropyuv", 0), 1);
    ASSERT_TRUE(m.GetTexture("sheenroughness"));
    const int roughness = m.GetTexture("sheenroughness")->floatIndex;
    EXPECT_EQ(d.textures.at(size_t(roughness)).parameters.GetString("channel", ""), "alpha");
    // The first texture coordinate grows along y; no tangents came with the mesh.
    const auto tangents = FloatsOf(d.shapes.at(0), ParameterType::Float, "tangent");
    ASSERT_EQ(tangents.size(), 12u);
    EXPECT_NEAR(tangents[1], 1, 1e-6);
}

TEST(GltfMaterials, CarryDiffuseTransmission) {
    GltfFile file;
    file.root["materials"] = {{{"extensions",
                                {{"KHR_materials_diffuse_transmission",
                                  {{"diffuseTransmissionFactor", 0.5},
                                   {"diffuseTransmissionColorFactor", {0.5, 0.25, 1}}}}}}}};
    file.root["extensionsRequired"] = {"KHR_materials_diffuse_transmission"};
    const int p = file.Floats({0, 0, 0, 1, 0, 0, 0, 1, 0}, "VEC3");
    file.Node({{"mesh", file.Mesh({{"POSITION", p}}, {{"material", 0}})}});
    const Parameters m = kFolder.Parse(file).materials.at(0).parameters;
    EXPECT_EQ(m.GetFloat("diffusetransmissionfactor", 0), 0.5f);
    EXPECT_TRUE(
        m.GetSpectrum("diffusetransmissioncolorfactor", Rgb::Zero()).isApprox(Rgb(0.5f, 0.25f, 1)));
}

GltfFile WithVariants() {
    GltfFile file;
    file.root["materials"] = {{{"name", "white"}}, {{"name", "red"}}, {{"name", "blue"}}};
    file.root["extensions"]["KHR_materials_variants"]["variants"] = {{{"name", "berry"}},
                                                                     {{"name", "sky"}}};
    file.root["extensionsRequired"] = {"KHR_materials_variants"};
    const json mappings = {{{"material", 1}, {"variants", {0}}},
                           {{"material", 2}, {"variants", {1}}}};
    file.Node(
        {{"mesh", file.Triangle(
                      {{"material", 0},
                       {"extensions", {{"KHR_materials_variants", {{"mappings", mappings}}}}}})}});
    file.Node({{"mesh", file.Triangle({{"material", 0}})}});
    return file;
}

TEST(GltfVariants, ChooseMaterialsByNameOrNumber) {
    const auto namesOf = [](const std::string& variant) {
        const Description d = kFolder.Parse(WithVariants(), {.variant = variant});
        EXPECT_EQ(d.variants, (std::vector<std::string>{"berry", "sky"}));
        std::vector<std::string> names;
        for (const ShapeEntity& shape : d.shapes)
            names.push_back(d.materials.at(size_t(shape.material)).materialName);
        return names;
    };
    EXPECT_EQ(namesOf(""), (std::vector<std::string>{"white", "white"}));
    for (const char* sky : {"sky", "1"})
        EXPECT_EQ(namesOf(sky), (std::vector<std::string>{"blue", "white"}));
    const std::string error = ErrorOf([&] { namesOf("fish"); });
    EXPECT_NE(error.find("has no variant \"fish\"; it has 0 \"berry\", 1 \"sky\""),
              std::string::npos)
        << error;
    GltfFile plain;
    plain.Node({{"mesh", plain.Triangle()}});
    const std::string none = ErrorOf([&] { kFolder.Parse(plain, {.variant = "0"}); });
    EXPECT_NE(none.find("has no variant \"0\"; it has none"), std::string::npos) << none;
}

TEST(GltfMaterials, KeepEmbeddedImagesEncoded) {
    GltfFile file;
    const std::string png = "\x89PNG and so on";
    const int view = file.View(png);
    file.root["images"] = {{{"bufferView", view}, {"mimeType", "image/png"}},
                           {{"uri", "data:image/jpeg;base64," + Base64("\xff\xd8jpeg")}}};
    file.root["textures"] = {{{"source", 0}}, {{"source", 1}}};
    file.root["materials"] = {{{"emissiveFactor", {1, 1, 1}},
                               {"emissiveTexture", {{"index", 1}}},
                               {"normalTexture", {{"index", 0}}}}};
    file.Node({{"mesh", file.Triangle({{"material", 0}})}});
    const Description d = kFolder.Parse(file);
    ASSERT_EQ(d.images.size(), 2u);
    EXPECT_EQ(d.images[0].type, "png");
    EXPECT_EQ(d.images[0].bytes.size(), png.size());
    EXPECT_EQ(d.images[1].type, "jpg");
    EXPECT_NE(d.images[0].name, d.images[1].name);
}

TEST(SceneEdits, LightOnlyWhatIsDark) {
    GltfFile file;
    file.Node({{"mesh", file.Triangle()}});
    Description d = kFolder.Parse(file);
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
    GltfFile file;
    file.Node({{"mesh", file.Triangle()}});
    Description d = kFolder.Parse(file, {.orbit = std::array{10.f, 20.f}});
    SetEnvironment("sky.exr", 0, &d);
    SetEnvironment("sky.exr", 90, &d);  // replaces the first
    ASSERT_EQ(d.lights.size(), 1u);
    const Mat4d& m = d.lights[0].worldFromLight;
    EXPECT_TRUE(TransformVector(m, Vec3f::UnitZ()).isApprox(Vec3f::UnitY()));
    EXPECT_LT(m.determinant(), 0);  // the world is right-handed
    // The file's format says where up is, not the camera, which may look down.
    Description above = kFolder.Parse(file, {.orbit = std::array{10.f, 90.f}});
    SetEnvironment("sky.exr", 90, &above);
    EXPECT_TRUE(above.lights[0].worldFromLight.isApprox(m));
    // A quarter turn, counterclockwise as seen from above, from where Blender has the image's edge.
    EXPECT_TRUE(TransformVector(m, Vec3f::UnitX()).isApprox(Vec3f::UnitZ()));
}

}  // namespace
}  // namespace lull
