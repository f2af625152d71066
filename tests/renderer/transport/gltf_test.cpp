// Renders glTF files whose radiance is known, or that exist as pbrt files as well.
#include <fmt/format.h>

#include "tests/renderer/transport/gltf_scene.h"

namespace lull::gltf_test {
namespace {

TEST(GltfScenes, AgreeWithPbrt) {
    // A coloured corner, lit by a lamp above and a point of light at the side; nothing in it is
    // symmetric.
    GltfFile file;
    file.Node({{"mesh", Square(&file, Matte(0.7, 0.6, 0.5))}, {"scale", {2, 2, 1}}});
    file.Node({{"mesh", Square(&file, Matte(0.2, 0.5, 0.8))},
               {"rotation", {0, std::sqrt(0.5), 0, std::sqrt(0.5)}},
               {"translation", {-1, 0, 1}}});
    json lamp = Matte(0, 0, 0);
    lamp["emissiveFactor"] = {1, 0.8, 0.6};
    lamp["extensions"]["KHR_materials_emissive_strength"] = {{"emissiveStrength", 5}};
    file.Node({{"mesh", Square(&file, lamp)},
               {"rotation", {1, 0, 0, 0}},
               {"translation", {0.5, 0.25, 2}},
               {"scale", {0.25, 0.5, 1}}});
    json back = Matte(0, 0, 0);
    back["doubleSided"] = true;
    file.Node({{"mesh", Square(&file, back)},
               {"translation", {0.5, 0.25, 2.0001}},
               {"scale", {0.25, 0.5, 1}}});
    file.Light({{"type", "point"}, {"intensity", 683}}, {{"translation", {0.5, -1, 0.5}}});
    file.root["cameras"] = {{{"type", "perspective"},
                             {"perspective", {{"yfov", 1}, {"aspectRatio", 1}, {"znear", 1}}}}};
    file.Node({{"camera", 0}, {"translation", {0.25, 0.5, 4}}});

    const auto pbrt = Compiled(fmt::format(R"(Scale -1 1 1 LookAt 0.25 0.5 4  0.25 0.5 0  0 1 0
Camera "perspective" "float fov" [{0}] Integrator "path" "integer maxdepth" [12]
WorldBegin LightSource "point" "rgb I" [1 1 1] "point from" [0.5 -1 0.5]
AttributeBegin Material "matte" "rgb Kd" [.7 .6 .5] Scale 2 2 1 {1} AttributeEnd
AttributeBegin Material "matte" "rgb Kd" [.2 .5 .8] Translate -1 0 1 Rotate 90 0 1 0 {1} AttributeEnd
AttributeBegin Material "matte" "rgb Kd" [0 0 0] AreaLightSource "diffuse" "rgb L" [5 4 3]
Translate 0.5 0.25 2 Rotate 180 1 0 0 Scale 0.25 0.5 1 {1} AttributeEnd WorldEnd)",
                                           180 / kPi, Quad("-1 -1 0  1 -1 0  1 1 0  -1 1 0")),
                               8);
    constexpr int kSamples = 1000;
    const auto pixelsOf = [](const Scene& scene, uint64_t seed) {
        return MeasurePixels(scene, Estimator::Combined, SamplerKind::Random, kSamples, seed);
    };
    const PixelStatistics a = pixelsOf(*Compiled(file, 8), 1), b = pixelsOf(*pbrt, 2);
    for (size_t i = 0; i < a.mean.size(); ++i)
        for (int c = 0; c < 3; ++c) {
            const double error = std::sqrt((a.variance[i][c] + b.variance[i][c]) / kSamples);
            EXPECT_LT(std::abs(a.mean[i][c] - b.mean[i][c]), 5 * error + 1e-4) << i << " " << c;
        }
}

// In an even environment a white material cannot be seen, whatever it is made of; a metal or a
// rough surface may lose some light, never more than what is scattered twice on a few facets.
TEST(GltfMaterial, NeverAddsEnergy) {
    struct Case {
        double metallic, roughness;
        const char* more;
        double least;
    };
    const Case cases[] = {
        {0, 1, "", 0.98},
        {0, .3, "", 0.98},
        {0, 0, "", 0.98},
        {1, .2, "", 0.98},
        {1, 1, "", 0.3},
        {.5, .5, "", 0.85},
        {0, 1, R"("float specularfactor" [0])", 0.999},
        {0, .4, R"("float ior" [2.5])", 0.97},
        {0, 1, R"("float clearcoatfactor" [1])", 0.98},
        {0, .5, R"("float clearcoatfactor" [1] "float clearcoatroughnessfactor" [1])", 0.97},
        {1, 0, R"("float clearcoatfactor" [1])", 0.998},
        {0, 0, R"("float clearcoatfactor" [1] "float transmissionfactor" [1])", 0.998},
        {0, 0, R"("float clearcoatfactor" [1] "float transmissionfactor" [1] "bool solid" "true")",
         0.998},
        {0, .2, R"("float clearcoatfactor" [1] "float clearcoatroughnessfactor" [.5]
                   "float transmissionfactor" [1] "bool solid" "true")",
         0.85},
        {0, .5, R"("float clearcoatfactor" [1] "float diffusetransmissionfactor" [1])", 0.97},
        {0, 0, R"("float transmissionfactor" [1])", 0.999},
        {0, .3, R"("float transmissionfactor" [1])", 0.95},
        {0, .3, R"("float transmissionfactor" [.5] "float clearcoatfactor" [.5])", 0.8},
        {0, 0, R"("float transmissionfactor" [1] "bool solid" "true")", 0.999},
        {0, .2, R"("float transmissionfactor" [.5] "bool solid" "true")", 0.85},
        {0, 1, R"("float sheenroughnessfactor" [.5] "rgb sheencolorfactor" [1 1 1])", 0.97},
        {0, 1, R"("float sheenroughnessfactor" [.1] "rgb sheencolorfactor" [1 1 1])", 0.97},
        {1, .2, R"("float anisotropyfactor" [.8])", 0.65},
        {0, .4, R"("float anisotropyfactor" [.5] "float clearcoatfactor" [1])", 0.8},
    };
    for (const Case& c : cases) {
        SCOPED_TRACE(fmt::format("{} {} {}", c.metallic, c.roughness, c.more));
        const auto scene = Compiled(
            fmt::format(R"(LookAt 0 0 -2.5  0 0 0  0 1 0 Camera "perspective" "float fov" [40]
Integrator "path" "integer maxdepth" [200] WorldBegin LightSource "infinite" "rgb L" [1 1 1]
Material "metallicroughness" "float metallicfactor" {} "float roughnessfactor" {} {}
Shape "sphere" "float radius" [2] WorldEnd)",
                        c.metallic, c.roughness, c.more),
            6);
        Total totals[2];
        for (int i = 0; i < 2; ++i) {
            totals[i] = Measure(*scene, kEstimators[i]);
            // The base's table of albedos is right to a hundredth.
            EXPECT_LT(totals[i].mean.y(), 1.01f + 4.5f * totals[i].error);
            EXPECT_GT(totals[i].mean.y(), c.least - 4.5f * totals[i].error);
        }
        EXPECT_LT(std::abs(totals[0].mean.y() - totals[1].mean.y()),
                  4.5f * std::hypot(totals[0].error, totals[1].error) + 1e-4f);
    }
}

// Emission leaves a clear coat but for what that reflects: 4 % along the normal.
TEST(GltfMaterial, EmitsBelowItsCoat) {
    for (const double tilt : {0., 1.2}) {
        GltfFile file;
        json lamp = Lamp();
        lamp["extensions"]["KHR_materials_clearcoat"] = {{"clearcoatFactor", 0.5}};
        file.Node({{"mesh", Square(&file, lamp)},
                   {"scale", {9, 9, 9}},
                   {"rotation", {std::sin(tilt / 2), 0, 0, std::cos(tilt / 2)}}});
        const double reflected = 0.04 + 0.96 * std::pow(1 - std::cos(tilt), 5);
        EXPECT_NEAR(Measure(*Compiled(file)).mean.y(), 1 - 0.5 * reflected, 1e-4);
    }
}

// What is seen from behind is open to the camera alone: the sheet has its shadow. Glass and
// double-sided sheets are there, and so is the front, however it is turned.
TEST(GltfMaterial, IsSingleSided) {
    for (const std::string how : {"front", "back", "mirrored", "instanced", "double", "glass"}) {
        GltfFile file;
        json sheet = Matte(0, 1, 0);
        if (how == "double") sheet["doubleSided"] = true;
        if (how == "glass")
            sheet["extensions"]["KHR_materials_transmission"] = {{"transmissionFactor", 0.5}};
        const int mesh = Square(&file, sheet);
        const bool isTurned = how != "front" && how != "mirrored";
        file.Node({{"mesh", mesh},
                   {"translation", {0, 0, 1}},
                   {"scale", {how == "mirrored" ? -3 : 3, 3, 1}},
                   {"rotation", isTurned ? json{0, 1, 0, 0} : json{0, 0, 0, 1}}});
        if (how == "instanced") file.Node({{"mesh", mesh}, {"translation", {100, 0, 0}}});
        file.Node({{"mesh", Square(&file, Matte(1, 1, 1))}});
        Sun(&file, Vec3f::UnitZ());
        LookDown(&file);
        Warnings warnings;
        const auto scene = Compile(kFolder.Parse(file, {}), ImageOf(4), warnings);
        const bool isOpen = how == "back" || how == "instanced";
        EXPECT_EQ(warnings.Total(), isOpen) << how;
        const Rgb seen = Measure(*scene, Estimator::Combined, 16).mean * kPi;
        if (isOpen) {
            EXPECT_TRUE(IsBlack(seen)) << how;
        } else {
            EXPECT_GT(seen.y(), 0.4f) << how;
        }
    }
}

// Adds a box about (0, 0, z) of glass that does not bend light, of which `color` is left after each
// half unit of length.
void AddBox(GltfFile* file, const json& color, double size, double z) {
    const json glass = {
        {"pbrMetallicRoughness", {{"metallicFactor", 0}, {"roughnessFactor", 0}}},
        {"extensions",
         {{"KHR_materials_ior", {{"ior", 1}}},
          {"KHR_materials_transmission", {{"transmissionFactor", 1}}},
          {"KHR_materials_volume",
           {{"thicknessFactor", 1}, {"attenuationDistance", 0.5}, {"attenuationColor", color}}}}}};
    const int face = Square(file, glass);
    const double half = std::sqrt(0.5), scale = size / 2;
    const json turns[] = {{0, 0, 0, 1},        {0, 1, 0, 0},       {0, half, 0, half},
                          {0, -half, 0, half}, {half, 0, 0, half}, {-half, 0, 0, half}};
    for (const json& turn : turns) {
        const Eigen::Quaterniond q(turn[3].get<double>(), turn[0].get<double>(),
                                   turn[1].get<double>(), turn[2].get<double>());
        const Eigen::Vector3d at = q * (scale * Eigen::Vector3d::UnitZ());
        file->Node({{"mesh", face},
                    {"rotation", turn},
                    {"scale", {scale, scale, scale}},
                    {"translation", {at.x(), at.y(), at.z() + z}}});
    }
}

GltfFile LampBelow() {
    GltfFile file;
    file.Node({{"mesh", Square(&file, Lamp())}, {"translation", {0, 0, -4}}});
    return file;
}

// The volume entered last counts, and those around it after it; a clear one leaves a hole in
// others. The camera may be in all of them.
TEST(GltfMaterial, VolumesLieInOthers) {
    const json red = {1, 0.5, 0.5}, green = {0.5, 1, 0.5}, clear = {1, 1, 1};
    const auto expect = [](GltfFile file, double r, double g, double b) {
        if (!file.root.contains("cameras")) LookDown(&file, 0.4);
        // Dim paths end at random.
        const Rgb L = Measure(*Compiled(file), Estimator::Combined, 400).mean;
        EXPECT_NEAR(L.x() * std::pow(2, r), 1, 0.02);
        EXPECT_NEAR(L.y() * std::pow(2, g), 1, 0.02);
        EXPECT_NEAR(L.z() * std::pow(2, b), 1, 0.02);
    };
    GltfFile nested = LampBelow();
    AddBox(&nested, red, 2, 0);
    AddBox(&nested, green, 1, 0);
    expect(nested, 2, 2, 4);
    GltfFile hollow = LampBelow();
    AddBox(&hollow, clear, 1, 0);
    AddBox(&hollow, red, 2, 0);
    expect(hollow, 0, 2, 2);
    GltfFile overlapping = LampBelow();
    AddBox(&overlapping, red, 2, 0);
    AddBox(&overlapping, green, 2, -1);
    expect(overlapping, 4, 2, 6);
    // What is behind two that touch is in none of them, whichever of the common faces rays meet.
    for (const double side : {1., -1.})
        for (const json& second : {red, green}) {
            GltfFile touching = LampBelow();
            AddBox(&touching, second, 2, side);
            AddBox(&touching, red, 2, -side);
            LookDown(&touching, 0.4);
            const Rgb L = Measure(*Compiled(touching), Estimator::Combined, 4000).mean;
            const double r = second == red ? 0 : 4, g = second == red ? 8 : 4;
            EXPECT_NEAR(L.x() * std::pow(2, r), 1, 0.05);
            EXPECT_NEAR(L.y() * std::pow(2, g), 1, 0.1);
            EXPECT_NEAR(L.z() * std::pow(2, 8), 1, 0.1);
        }
    // From the middle of both on.
    nested.root["cameras"] = {
        {{"type", "perspective"}, {"perspective", {{"yfov", 0.01}, {"znear", 0.01}}}}};
    nested.Node({{"camera", 0}});
    expect(nested, 1, 1, 2);
}

// A box of glass that does not bend light, 2 deep, in front of a lamp: a quarter of the red light
// is left after each unit of length, and all of the blue.
TEST(GltfMaterial, AbsorbsByTheLengthOfTheWayThrough) {
    GltfFile file = LampBelow();
    AddBox(&file, {0.5, 0, 1}, 2, 0);
    for (const Estimator estimator : kEstimators) {
        const Rgb L = Measure(*Compiled(file), estimator, 4).mean;
        EXPECT_NEAR(L.x(), 1 / 16., 1e-4);
        EXPECT_EQ(L.y(), 0);
        EXPECT_NEAR(L.z(), 1, 1e-4);
    }
}

// While the shutter is open a square moves by twice its width over a ground of another colour.
TEST(GltfShutter, BlursByTheTimeThatIsCovered) {
    GltfFile file;
    const int times = file.Floats({0, 1}, "SCALAR");
    const int ways = file.Floats({-2, 0, 1, 2, 0, 1}, "VEC3");
    file.Node({{"mesh", Square(&file, Matte(1, 0, 0))}, {"scale", {4, 4, 1}}});
    file.Node({{"mesh", Square(&file, Matte(0, 1, 0))}, {"scale", {1, 4, 1}}});
    file.root["animations"] = {
        {{"samplers", {{{"input", times}, {"output", ways}}}},
         {"channels", {{{"sampler", 0}, {"target", {{"node", 1}, {"path", "translation"}}}}}}}};
    Sun(&file, Vec3f::UnitZ());
    LookDown(&file);
    // It covers each point that is seen for half of the time.
    const auto blurred = Compiled(kFolder.Parse(file, {.frame = 0, .shutter = 1}), 4);
    const Total t = Measure(*blurred, Estimator::Combined, 4000);
    EXPECT_NEAR(t.mean.y() * kPi, 0.5, 4.5 * t.error * kPi);
    EXPECT_NEAR(t.mean.x() + t.mean.y(), 1 / kPi, 1e-4);
    EXPECT_GT(t.error, 0);
    // At half that time it stands in the middle.
    EXPECT_NEAR(Measure(*Compiled(kFolder.Parse(file, {.frame = 0.5}), 4)).mean.y() * kPi, 1, 1e-4);
}

// The normal map turns the square towards or away from the sun: red to the right, green upwards.
TEST(GltfMaterial, FollowsItsNormalMap) {
    const Vec3f right(0.6f, 0, 0.8f), up(0, 0.6f, 0.8f), left(-0.6f, 0, 0.8f);
    const auto radiance = [](const std::array<int, 3>& texel, const Vec3f& sun, const json& turn) {
        GltfFile file;
        json material = Matte(1, 1, 1);
        material["normalTexture"] = {{"index", Texture(&file, {texel}, 1)}};
        json node = {{"mesh", Square(&file, material, true)}};
        node.update(turn);
        file.Node(node);
        Sun(&file, sun);
        return Measure(*Compiled(file), Estimator::Combined, 4).mean.y() * kPi;
    };
    const std::array<int, 3> toRight = {204, 128, 230}, toUp = {128, 204, 230};
    EXPECT_NEAR(radiance(toRight, right, json::object()), 1, 0.01);
    EXPECT_NEAR(radiance(toRight, left, json::object()), 0.28, 0.01);
    EXPECT_NEAR(radiance(toUp, up, json::object()), 1, 0.01);
    EXPECT_NEAR(radiance(toUp, right, json::object()), 0.64, 0.01);
    // Mirrored, right becomes left; turned by a quarter, right becomes up.
    EXPECT_NEAR(radiance(toRight, left, {{"scale", {-1, 1, 1}}}), 1, 0.01);
    EXPECT_NEAR(radiance(toRight, up, {{"rotation", {0, 0, std::sqrt(0.5), std::sqrt(0.5)}}}), 1,
                0.01);
}

// The front that emits is where triangles run counterclockwise, in the node's space, whatever their
// normals say: mirrored nodes keep it.
TEST(GltfMaterial, EmitsOnTheFrontOfTriangles) {
    json lamp = Lamp();
    for (const json& scale : {json{1, 1, 1}, {-1, 1, 1}, {1, 1, -1}, {-1, -1, -1}, {-1, -1, 1}})
        for (const float normal : {0.f, 1.f, -1.f})
            for (const bool isInstanced : {false, true}) {
                GltfFile file;
                const int mesh = Square(&file, lamp);
                if (normal != 0) {
                    std::vector<float> normals;
                    for (int i = 0; i < 4; ++i) normals.insert(normals.end(), {0, 0, normal});
                    file.root["meshes"][size_t(mesh)]["primitives"][0]["attributes"]["NORMAL"] =
                        file.Floats(normals, "VEC3");
                }
                file.Node({{"mesh", mesh}, {"scale", scale}});
                if (isInstanced) file.Node({{"mesh", mesh}, {"translation", {100, 0, 0}}});
                // A white wall tells that light sampling agrees.
                file.Node({{"mesh", Square(&file, Matte(1, 1, 1))},
                           {"translation", {0, 0, 1}},
                           {"rotation", {1, 0, 0, 0}}});
                file.root["cameras"] = {
                    {{"type", "orthographic"},
                     {"orthographic", {{"xmag", 1}, {"ymag", 1}, {"znear", 0}, {"zfar", 10}}}}};
                const bool isSeen = scale[2] > 0;
                GltfFile front = file, wall = file;
                front.Node({{"camera", 0}, {"translation", {0, 0, 0.5}}});
                wall.Node(
                    {{"camera", 0}, {"translation", {0, 0, 0.5}}, {"rotation", {0, 1, 0, 0}}});
                EXPECT_EQ(Measure(*Compiled(front, 4, !isSeen), Estimator::Combined, 4).mean.y(),
                          isSeen)
                    << scale << normal << isInstanced;
                const float lit = Measure(*Compiled(wall), Estimator::PbrtV3, 64).mean.y();
                EXPECT_EQ(lit > 0.1f, isSeen) << scale << normal << isInstanced;
            }
}

TEST(GltfMaterial, ShowsTheColoursOfUnlitVertices) {
    GltfFile file;
    const int mesh =
        Square(&file, {{"extensions", {{"KHR_materials_unlit", json::object()}}},
                       {"pbrMetallicRoughness", {{"baseColorFactor", {1, 1, 0.5, 1}}}}});
    file.root["meshes"][size_t(mesh)]["primitives"][0]["attributes"]["COLOR_0"] =
        file.Floats({1, 0, 0, 0, 1, 0, 0, 0, 1, 1, 1, 1}, "VEC3");
    file.Node({{"mesh", mesh}});
    const auto pixels =
        MeasurePixels(*Compiled(file, 40), Estimator::Combined, SamplerKind::Random, 4, 1);
    const auto at = [&](int x, int y) { return pixels.mean[size_t(40 * y + x)]; };
    EXPECT_TRUE(at(0, 39).isApprox(Eigen::Array3d(1, 0, 0), 0.05));
    EXPECT_TRUE(at(39, 39).isApprox(Eigen::Array3d(0, 1, 0), 0.05));
    EXPECT_TRUE(at(39, 0).isApprox(Eigen::Array3d(0, 0, 0.5), 0.05));
    EXPECT_TRUE(at(0, 0).isApprox(Eigen::Array3d(1, 1, 0.5), 0.05));
}

TEST(GltfMaterial, ShowsItsTextureUpright) {
    GltfFile file;
    json material = Matte(1, 1, 1);
    // Red above green, left of blue and black.
    const int texture = Texture(&file, {{255, 0, 0}, {0, 0, 255}, {0, 255, 0}, {0, 0, 0}}, 2);
    file.root["samplers"] = {{{"wrapS", 33071}, {"wrapT", 33648}}};
    file.root["textures"][0]["sampler"] = 0;
    material["pbrMetallicRoughness"]["baseColorTexture"] = {{"index", texture}};
    file.Node({{"mesh", Square(&file, material, true)}});
    Sun(&file, Vec3f::UnitZ());
    const auto pixels =
        MeasurePixels(*Compiled(file, 4), Estimator::Combined, SamplerKind::Random, 64, 1);
    const auto at = [&](int x, int y) -> Rgb {
        return (pixels.mean[size_t(4 * y + x)] * kPi).cast<float>();
    };
    EXPECT_LT((at(0, 0) - Rgb(1, 0, 0)).abs().maxCoeff(), 0.05f);
    EXPECT_LT((at(3, 0) - Rgb(0, 0, 1)).abs().maxCoeff(), 0.05f);
    EXPECT_LT((at(0, 3) - Rgb(0, 1, 0)).abs().maxCoeff(), 0.05f);
    EXPECT_LT(at(3, 3).maxCoeff(), 0.05f);
}

// A quarter of the light passes a square of alpha 0.75, to the camera and to what is below.
TEST(GltfMaterial, LetsLightThroughByItsAlpha) {
    GltfFile file;
    json veil = Matte(0, 0, 0);
    veil["alphaMode"] = "BLEND";
    veil["pbrMetallicRoughness"]["baseColorFactor"] = {0, 0, 0, 0.75};
    file.Node({{"mesh", Square(&file, veil)}, {"translation", {0, 0, 1}}});
    file.Node({{"mesh", Square(&file, Matte(1, 1, 1))}});
    Sun(&file, Vec3f::UnitZ());
    const Total t = Measure(*Compiled(file), Estimator::Combined, 20000);
    EXPECT_NEAR(t.mean.y() * kPi, 1 / 16., 4.5 * t.error * kPi);
    EXPECT_GT(t.error, 0);
    // With a cutoff it is there or not.
    for (const double cutoff : {0.5, 0.8}) {
        file.root["materials"][0]["alphaMode"] = "MASK";
        file.root["materials"][0]["alphaCutoff"] = cutoff;
        EXPECT_NEAR(Measure(*Compiled(file)).mean.y() * kPi, cutoff > 0.75 ? 1 : 0, 1e-4);
    }
}

// Neither the camera nor the sun see a square from behind that is open there.
TEST(GltfMaterial, MayBeOpenBehind) {
    for (const bool isOpen : {false, true})
        for (const bool fromBehind : {false, true})
            for (const bool isInstanced : {false, true}) {
                json panel = Lamp();
                if (isOpen) panel["extras"] = {{"lull", {{"openBehind", true}}}};
                GltfFile file;
                const int mesh = Square(&file, panel);
                const json turn = fromBehind ? json{1, 0, 0, 0} : json{0, 0, 0, 1};
                file.Node({{"mesh", mesh}, {"translation", {0, 0, 1}}, {"rotation", turn}});
                if (isInstanced) file.Node({{"mesh", mesh}, {"translation", {100, 0, 0}}});
                file.Node({{"mesh", Square(&file, Matte(1, 1, 1))}});
                Sun(&file, Vec3f::UnitZ());
                const float seen =
                    Measure(*Compiled(file, 4, fromBehind && !isOpen), Estimator::Combined, 400)
                        .mean.y();
                // Behind the panel is the floor, which it lights.
                EXPECT_NEAR(seen, fromBehind ? 0.416f : 1, fromBehind ? 0.02f : 1e-4f);
            }
}

TEST(GltfMaterial, ColoursItsVertices) {
    GltfFile file;
    const int mesh = Square(&file, Matte(1, 0.5, 1));
    file.root["meshes"][size_t(mesh)]["primitives"][0]["attributes"]["COLOR_0"] =
        file.Floats({0.5, 1, 0, 0.5, 1, 0, 0.5, 1, 0, 0.5, 1, 0}, "VEC3");
    file.Node({{"mesh", mesh}});
    Sun(&file, Vec3f::UnitZ());
    EXPECT_LT((Measure(*Compiled(file)).mean * kPi - Rgb(0.5f, 0.5f, 0)).abs().maxCoeff(), 1e-4f);
}

// A lamp whose left half shines: the camera sees it, and both ways of sampling it agree about what
// it lights.
TEST(GltfMaterial, EmitsByItsTexture) {
    GltfFile file;
    json lamp = Lamp();
    lamp["doubleSided"] = true;
    lamp["emissiveTexture"] = {{"index", Texture(&file, {{255, 255, 255}, {0, 0, 0}}, 2)}};
    file.Node({{"mesh", Square(&file, lamp, true)}});
    const Total seen = Measure(*Compiled(file));
    EXPECT_NEAR(seen.mean.y(), 0.5, 4.5 * seen.error);

    file.Node({{"mesh", Square(&file, Matte(1, 1, 1))}, {"translation", {0, 0, -1}}});
    file.root["cameras"] = {
        {{"type", "perspective"}, {"perspective", {{"yfov", 0.5}, {"znear", 1}}}}};
    file.Node(
        {{"camera", 0}, {"translation", {1.5, 0, -0.5}}, {"rotation", {0, 0.5, 0, 0.8660254}}});
    const auto scene = Compiled(file);
    const Total a = Measure(*scene, kEstimators[0], 1000),
                b = Measure(*scene, kEstimators[1], 1000);
    EXPECT_GT(a.mean.y(), 0.01);
    EXPECT_NEAR(a.mean.y(), b.mean.y(), 4.5 * std::hypot(a.error, b.error));
}

// KHR_lights_punctual: ((cos - cos outer) / (cos inner - cos outer))^2 between the two cones.
TEST(GltfLights, FallOffInTheirCone) {
    for (const double tangent : {0.0, 0.3, 0.45, 0.6}) {
        GltfFile file;
        file.Node({{"mesh", Square(&file, Matte(1, 1, 1))}, {"scale", {0.01, 0.01, 1}}});
        const double outer = 0.5, inner = 0.2;
        file.Light({{"type", "spot"},
                    {"intensity", 683},
                    {"spot", {{"innerConeAngle", inner}, {"outerConeAngle", outer}}}},
                   {{"translation", {tangent, 0, 1}}});
        LookDown(&file, 1e-3);
        const double cosine = 1 / std::hypot(1, tangent), distance2 = 1 + tangent * tangent;
        const double x =
            std::clamp((cosine - std::cos(outer)) / (std::cos(inner) - std::cos(outer)), 0.0, 1.0);
        EXPECT_NEAR(Measure(*Compiled(file), Estimator::Combined, 4).mean.y() * kPi,
                    x * x * cosine / distance2, 2e-3)
            << tangent;
    }
}

}  // namespace
}  // namespace lull::gltf_test
