// Renders glTF files of which the camera or shadow rays do not see all.
#include "tests/renderer/transport/gltf_scene.h"

namespace lull::gltf_test {
namespace {

// A green sheet under the sun, above a white floor. Seen, the sheet is in the picture; hidden from
// the camera, the floor is, in its shadow unless it casts none. It is the node's property or the
// material's; the sheet is an instance, or moves, or shadow rays look for media, as there is glass.
TEST(GltfNode, MayBeHiddenFromTheCameraAndShadowRays) {
    for (const bool isHidden : {false, true})
        for (const bool isShadowless : {false, true})
            for (const std::string how : {"node", "material", "twice", "moving", "media"}) {
                GltfFile file;
                const int mesh = Square(&file, Matte(0, 1, 0));
                json sheet = {{"mesh", mesh}, {"translation", {0, 0, 1}}, {"scale", {3, 3, 1}}};
                json& owner = how == "material" ? file.root["materials"][0] : sheet;
                owner["extras"]["lull"] = {{"hiddenFromCamera", isHidden},
                                           {"castsNoShadow", isShadowless}};
                file.Node(sheet);
                if (how == "twice") {
                    sheet["translation"] = {100, 0, 0};
                    file.Node(sheet);
                }
                if (how == "moving") {
                    const int times = file.Floats({0, 1}, "SCALAR");
                    const int ways = file.Floats({0, 0, 1, 1, 0, 1}, "VEC3");
                    file.root["animations"] = {
                        {{"samplers", {{{"input", times}, {"output", ways}}}},
                         {"channels",
                          {{{"sampler", 0}, {"target", {{"node", 0}, {"path", "translation"}}}}}}}};
                }
                if (how == "media") {
                    json glass = Matte(1, 1, 1);
                    glass["extensions"] = {
                        {"KHR_materials_transmission", {{"transmissionFactor", 1}}},
                        {"KHR_materials_volume",
                         {{"thicknessFactor", 1},
                          {"attenuationDistance", 1},
                          {"attenuationColor", {0.5, 0.5, 0.5}}}}};
                    file.Node({{"mesh", Square(&file, glass)}, {"translation", {100, 0, 0}}});
                }
                file.Node({{"mesh", Square(&file, Matte(1, 1, 1))}});
                Sun(&file, Vec3f::UnitZ());
                LookDown(&file);
                const GltfFolder folder;
                const GltfOptions opened{.frame = 0, .shutter = 1};
                Description d = folder.Parse(file, how == "moving" ? opened : GltfOptions());
                for (const bool isBidirectional : {false, true}) {
                    if (isBidirectional && how == "media") continue;  // which bdpt has not
                    if (isBidirectional) d.integrator.name = "bdpt";
                    const Rgb seen = Measure(*Compiled(d, 4), Estimator::Combined, 16).mean * kPi;
                    EXPECT_NEAR(seen.x(), isHidden && isShadowless ? 1 : 0, 1e-4f)
                        << how << ' ' << isHidden << isShadowless << isBidirectional;
                    if (!isHidden) {
                        EXPECT_NEAR(seen.y(), 1, 1e-4f) << how;
                    }
                }
            }
}

// The camera sees no sphere of a hidden light, which lights the floor as the point does.
TEST(GltfNode, HidesTheSphereOfItsLight) {
    for (const bool isHidden : {false, true}) {
        GltfFile file;
        file.Node({{"mesh", Square(&file, Matte(1, 1, 1))}, {"scale", {0.05, 0.05, 1}}});
        const int bulb = AddLight(
            &file,
            {{"type", "point"}, {"intensity", 683}, {"extras", {{"lull", {{"radius", 0.5}}}}}});
        json node = {{"translation", {0, 0, 1}},
                     {"extensions", {{"KHR_lights_punctual", {{"light", bulb}}}}}};
        if (isHidden) node["extras"] = {{"lull", {{"hiddenFromCamera", true}}}};
        file.Node(node);
        LookDown(&file, 0.04);
        const Total t = Measure(*Compiled(file), Estimator::Combined, 1000);
        // A bulb that is seen adds its own radiance: a watt per steradian from a disk of that
        // radius.
        const double bulbs = isHidden ? 0 : 1 / (kPi * 0.25);
        EXPECT_NEAR(t.mean.y(), bulbs + 1 / kPi, 4.5 * t.error + 2e-3) << isHidden;
    }
}

// A lamp hidden from the camera lights the floor: of two parallel squares of side 2 at a distance
// of 1, each is lit by 0.4153 of what the other sends (Hottel's form factor).
TEST(GltfNode, ShinesWhereItIsHidden) {
    GltfFile file;
    json lamp = Lamp();
    lamp["doubleSided"] = true;
    file.Node({{"mesh", Square(&file, lamp)},
               {"translation", {0, 0, 1}},
               {"extras", {{"lull", {{"hiddenFromCamera", true}}}}}});
    file.Node({{"mesh", Square(&file, Matte(1, 1, 1))}});
    const Total t = Measure(*Compiled(file), Estimator::Combined, 4000);
    EXPECT_NEAR(t.mean.y(), 0.4153, 4.5 * t.error + 1e-4);
}

}  // namespace
}  // namespace lull::gltf_test
