// Checks lights of glTF files.
#include "tests/renderer/input/gltf_files.h"

namespace lull::gltf_lights_test {
namespace {

TEST(GltfLights, AreTakenFromPhotometricUnits) {
    GltfFile file;
    const json scaled = {{"scale", {3, 3, 3}}};
    file.Light({{"type", "point"}, {"intensity", 683}, {"color", {1, 0.5, 0}}}, scaled);
    file.Light({{"type", "directional"}, {"intensity", 1366}}, scaled);
    file.Light({{"type", "spot"}, {"spot", {{"innerConeAngle", 0.2}, {"outerConeAngle", 0.5}}}},
               scaled);
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
        file.Light({{"type", "spot"}, {"spot", spot}});
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
        EXPECT_HAS(kFolder.ErrorOf(cone({{"innerConeAngle", inner}, {"outerConeAngle", outer}})),
                   "the cone's angles are")
            << inner << " " << outer;
}

TEST(GltfLights, AreSpheresWithARadiusOfOurOwn) {
    GltfFile file;
    for (const double radius : {0.5, 0.})
        file.Light(
            {{"type", "point"}, {"intensity", 683}, {"extras", {{"lull", {{"radius", radius}}}}}},
            {{"translation", {1, 2, 3}}, {"scale", {3, 3, 3}}});
    const Description d = kFolder.Parse(file);
    EXPECT_EQ(d.lights.size(), 1u);
    ASSERT_EQ(d.shapes.size(), 1u);
    const ShapeEntity& sphere = d.shapes[0];
    EXPECT_EQ(sphere.name, "sphere");
    EXPECT_EQ(sphere.parameters.GetFloat("radius", 0), 0.5f);
    EXPECT_TRUE(TransformPoint(sphere.worldFromObject, {0, 0.5f, 0}).isApprox(Vec3f(1, 2.5f, 3)));
    ASSERT_TRUE(sphere.areaLight);
    // A watt per steradian, seen as a disk of that radius.
    EXPECT_TRUE(sphere.areaLight->parameters.GetSpectrum("L", Rgb::Zero())
                    .isApprox(Rgb::Constant(4 / kPi)));
}

TEST(GltfLights, AreSpheresThatShineAsSpots) {
    GltfFile file;
    file.Light({{"type", "spot"},
                {"intensity", 683},
                {"spot", {{"innerConeAngle", 0.5}, {"outerConeAngle", 1}}},
                {"extras", {{"lull", {{"radius", 0.5}}}}}});
    const Description d = kFolder.Parse(file);
    EXPECT_TRUE(d.lights.empty());
    ASSERT_TRUE(d.shapes.at(0).areaLight);
    EXPECT_EQ(d.shapes[0].areaLight->name, "spot-squared");
    const Parameters& light = d.shapes[0].areaLight->parameters;
    EXPECT_TRUE(light.GetSpectrum("L", Rgb::Zero()).isApprox(Rgb::Constant(4 / kPi)));
    EXPECT_TRUE(light.GetPoint3("to", Vec3f::Zero()).isApprox(Vec3f(0, 0, -1)));
    EXPECT_NEAR(light.GetFloat("coneangle", 0), 180 / kPi, 1e-4f);
    EXPECT_NEAR(light.GetFloat("conedeltaangle", 0), 90 / kPi, 1e-4f);
}

// A sphere under a mirroring transform shines inwards; their axis is that of the node.
TEST(GltfLights, AreSpheresThatShineOutwardsInMirroredNodes) {
    for (const json& scale : {json{-1, 1, 1}, json{1, 1, -1}, json{-2, -2, -2}}) {
        GltfFile file;
        file.Light(
            {{"type", "spot"}, {"spot", json::object()}, {"extras", {{"lull", {{"radius", 0.5}}}}}},
            {{"scale", scale}});
        const Mat4d m = kFolder.Parse(file).shapes.at(0).worldFromObject;
        EXPECT_NEAR((m.topLeftCorner<3, 3>().determinant()), 1, 1e-12) << scale;
        EXPECT_EQ(m(2, 2), scale[2] < 0 ? -1 : 1) << scale;
    }
}

// They shine along the -z axis that a node's negative scale has turned, whatever its size.
TEST(GltfLights, AreMirroredWithTheirNodes) {
    const auto axisOf = [](const std::vector<double>& scale) {
        GltfFile file;
        file.Light({{"type", "spot"}, {"spot", {{"outerConeAngle", 1}}}}, {{"scale", scale}});
        const LightEntity light = kFolder.Parse(file).lights.at(0);
        EXPECT_NEAR(light.parameters.GetFloat("coneangle", 0), 180 / kPi, 1e-4f);
        return TransformVector(light.worldFromLight, {0, 0, -1});
    };
    EXPECT_TRUE(axisOf({-2, 2, 2}).isApprox(Vec3f(0, 0, -1)));
    EXPECT_TRUE(axisOf({2, 2, -2}).isApprox(Vec3f(0, 0, 1)));
    EXPECT_TRUE(axisOf({-3, -3, -3}).isApprox(Vec3f(0, 0, 1)));
}

TEST(GltfLights, HaveAProfileOfOurOwn) {
    const auto fileWith = [](const json& light) {
        GltfFile file;
        file.Light(light, {{"translation", {1, 2, 3}}, {"scale", {3, 3, 3}}});
        return file;
    };
    const json profile = {{"lull", {{"profile", "lamp.exr"}}}};
    const Description d =
        kFolder.Parse(fileWith({{"type", "point"}, {"intensity", 683}, {"extras", profile}}));
    ASSERT_EQ(d.lights.size(), 1u);
    const LightEntity& light = d.lights[0];
    EXPECT_EQ(light.name, "goniometric");
    EXPECT_EQ(light.parameters.GetString("mapname", ""), "lamp.exr");
    EXPECT_TRUE(light.parameters.GetSpectrum("I", Rgb::Zero()).isApprox(Rgb::Ones()));
    // The pole of the image is where spots shine to; a quarter of a turn leads from x to y.
    const auto direction = [&](const Vec3f& w) {
        return Vec3f(TransformPoint(light.worldFromLight, w) - Vec3f(1, 2, 3));
    };
    EXPECT_TRUE(direction({0, 1, 0}).isApprox(Vec3f(0, 0, -1)));
    EXPECT_TRUE(direction({1, 0, 0}).isApprox(Vec3f(1, 0, 0)));
    EXPECT_TRUE(direction({0, 0, 1}).isApprox(Vec3f(0, 1, 0)));

    const json bad[] = {
        {{"type", "directional"}, {"extras", profile}},
        {{"type", "spot"}, {"extras", profile}, {"spot", json::object()}},
        {{"type", "point"}, {"extras", {{"lull", {{"profile", "a.exr"}, {"radius", 1}}}}}},
        {{"type", "point"}, {"extras", {{"lull", {{"profile", 3}}}}}},
        {{"type", "point"}, {"extras", {{"lull", {{"profile", ""}}}}}}};
    for (const json& each : bad) EXPECT_HAS(kFolder.ErrorOf(fileWith(each)), "profile") << each;
}

TEST(GltfLights, HaveAnAngleOfOurOwn) {
    const auto parse = [&](double angle) {
        GltfFile file;
        file.Light({{"type", "directional"}, {"extras", {{"lull", {{"angle", angle}}}}}});
        return kFolder.Parse(file);
    };
    const Description d = parse(double(kPi) / 180);
    ASSERT_EQ(d.lights.size(), 1u);
    EXPECT_NEAR(d.lights[0].parameters.GetFloat("angle", 0), 1, 1e-6);
    EXPECT_EQ(parse(0).lights[0].parameters.GetFloat("angle", -1), -1);
    EXPECT_HAS(ErrorOf([&] { parse(-1); }), "its angle is -1");
}

TEST(GltfLights, AreNamedByTheNodeOrTheLight) {
    GltfFile file;
    const json bulb = {{"type", "point"}, {"name", "bulb"}};
    file.Light(bulb);
    file.Light(bulb, {{"name", "lamp"}});
    file.Light({{"type", "point"}, {"name", "ball"}, {"extras", {{"lull", {{"radius", 0.5}}}}}});
    const Description d = kFolder.Parse(file);
    ASSERT_EQ(d.lights.size(), 2u);
    EXPECT_EQ(d.lights[0].label, "bulb");
    EXPECT_EQ(d.lights[1].label, "lamp");
    ASSERT_EQ(d.shapes.size(), 1u);
    EXPECT_EQ(d.shapes[0].label, "ball");
}

}  // namespace
}  // namespace lull::gltf_lights_test
