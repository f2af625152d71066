// Tests that the shared real scenes are read as their inventory says.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <map>

#include "renderer/input/loop_subdivision.h"
#include "renderer/input/pbrt_parser.h"
#include "renderer/input/ply_loader.h"
#include "tests/shared_folder.h"

namespace lull {
namespace {

using Counts = std::map<std::string, int>;

std::string TextOf(const Counts& counts) {
    std::string text;
    for (const auto& [name, count] : counts)
        text += fmt::format("{}{} {}", text.empty() ? "" : ", ", name, count);
    return text;
}

// What the inventory says of a scene: how many of each name. Materials are those defined; lights
// and area lights those in force.
struct Inventory {
    std::string file;
    size_t triangles;
    std::string materials, lights, textures;
    int depth;
    size_t quadrics = 0;  // spheres and disks
};

void PrintTo(const Inventory& inventory, std::ostream* out) { *out << inventory.file; }

size_t CountTriangles(const ShapeEntity& shape, const Description& d, Warnings& warnings) {
    const Parameters& p = shape.parameters;
    if (shape.name == "plymesh") {
        const std::string file = ResolvePath(d, p.GetString("filename", ""));
        return LoadPly(file, warnings, shape.loc).triangles.size();
    }
    if (shape.name == "loopsubdiv")
        return LoopSubdivide(p.GetFloats(ParameterType::Point3, "P"), p.GetInts("indices"),
                             p.GetInt("levels", p.GetInt("nlevels", 3)), shape.loc)
            .triangles.size();
    return p.GetInts("indices").size() / 3;
}

size_t CountTriangles(const Description& d, Warnings& warnings) {
    size_t count = 0;
    for (const ShapeEntity& shape : d.shapes) count += CountTriangles(shape, d, warnings);
    std::vector<size_t> ofObject;
    for (const ObjectEntity& object : d.objects) {
        ofObject.push_back(0);
        for (const ShapeEntity& shape : object.shapes)
            ofObject.back() += CountTriangles(shape, d, warnings);
    }
    for (const InstanceEntity& instance : d.instances) count += ofObject[instance.object];
    return count;
}

class Scenes : public testing::TestWithParam<Inventory> {};

TEST_P(Scenes, MatchTheInventory) {
    const Inventory& expected = GetParam();
    LULL_SHARED_FILE(file, std::filesystem::path("pbrt-scenes") / expected.file);
    Warnings warnings;
    const Description d = ParsePbrt(file.string(), warnings);
    EXPECT_EQ(CountTriangles(d, warnings), expected.triangles);

    Counts materials, lights, textures;
    size_t quadrics = 0;
    // The matte of shapes without a material is not in the file.
    for (const MaterialEntity& material : d.materials)
        if (material.name != "matte" || !material.parameters.All().empty())
            ++materials[material.name];
    for (const LightEntity& light : d.lights) ++lights[light.name];
    for (const ShapeEntity& shape : d.shapes) {
        if (shape.areaLight) ++lights["area"];
        quadrics += shape.name == "sphere" || shape.name == "disk";
        EXPECT_LT(size_t(shape.material), d.materials.size());
    }
    for (const TextureEntity& texture : d.textures)
        ++textures[(texture.isSpectrum ? "spectrum " : "float ") + texture.name];
    EXPECT_EQ(TextOf(materials), expected.materials);
    EXPECT_EQ(TextOf(lights), expected.lights);
    EXPECT_EQ(TextOf(textures), expected.textures);
    EXPECT_EQ(quadrics, expected.quadrics);

    EXPECT_EQ(d.integrator.name, "path");
    EXPECT_EQ(d.integrator.parameters.GetInt("maxdepth", 5), expected.depth);
    EXPECT_EQ(d.film.parameters.GetInt("xresolution", 0), 800);
    EXPECT_EQ(d.film.parameters.GetInt("yresolution", 0), 800);
    EXPECT_EQ(d.sampler.name, "random");
    EXPECT_EQ(d.filter.name, "box");
    EXPECT_EQ(d.camera.name, "perspective");
    // No texture is named in vain.
    for (const MaterialEntity& material : d.materials)
        for (const Parameter& parameter : material.parameters.All())
            if (parameter.type == ParameterType::Texture) {
                const auto& ref = std::get<std::vector<TextureRef>>(parameter.values)[0];
                EXPECT_TRUE(ref.floatIndex >= 0 || ref.spectrumIndex >= 0)
                    << parameter.loc.Prefix() << ref.name;
            }
}

std::vector<Inventory> Inventories() {
    return {
        {"bathroom/scene.pbrt", 449049,
         "glass 1, matte 7, metal 2, mirror 1, plastic 1, substrate 1, uber 7", "area 5",
         "float fbm 1, float scale 1, spectrum imagemap 2", 5},
        {"breakfast/scene.pbrt", 533260, "glass 1, matte 6, metal 2, plastic 7", "distant 1",
         "float imagemap 1, spectrum imagemap 2, spectrum marble 1", 5},
        {"caustic-glass/scene.pbrt", 88066, "glass 1, uber 1", "infinite 1, spot 1", "", 20},
        {"classroom/scene.pbrt", 103832, "matte 36, metal 3, plastic 1, substrate 4", "infinite 1",
         "spectrum imagemap 3", 17},
        {"coffee-splash/scene.pbrt", 298912, "glass 1, matte 2, metal 1, plastic 1", "infinite 1",
         "", 25},
        {"contemporary-bathroom/scene.pbrt", 592188,
         "matte 19, metal 4, mirror 1, plastic 2, substrate 5, uber 1", "area 1",
         "float imagemap 3, spectrum imagemap 8", 17},
        {"cornell-box/scene.pbrt", 36, "matte 8", "area 1", "", 65},
        {"crown/scene.pbrt", 3540214, "glass 6, matte 5, metal 31, mix 2, substrate 1, uber 6",
         "area 6", "float imagemap 5, float scale 4, spectrum imagemap 4, spectrum scale 2", 20, 1},
        {"dining-room/scene.pbrt", 269538, "matte 5, metal 3, substrate 7", "infinite 1",
         "spectrum imagemap 3", 65},
        {"killeroo-simple/scene.pbrt", 66532, "matte 2, plastic 2", "area 1", "", 5, 1},
        {"living-room/scene.pbrt", 143163,
         "glass 1, matte 11, metal 1, mirror 2, substrate 3, translucent 1", "infinite 1",
         "float imagemap 1, spectrum imagemap 4", 65},
        {"matpreview/scene.pbrt", 61600, "matte 2, metal 1", "infinite 1",
         "spectrum checkerboard 1", 10},
        {"staircase/scene.pbrt", 262663, "glass 1, matte 13, metal 5, substrate 6", "area 1",
         "float imagemap 1, spectrum imagemap 9", 65},
        {"staircase2/scene.pbrt", 30927, "glass 1, matte 16, metal 2, substrate 2", "area 13",
         "spectrum imagemap 3", 65, 5},
        {"veach-ajar/scene.pbrt", 382690, "glass 1, matte 9, metal 4, mix 1", "area 1",
         "spectrum checkerboard 1, spectrum imagemap 3", 13},
        {"veach-bidir/scene.pbrt", 11544, "glass 1, matte 2, metal 1", "area 2", "", 65},
        {"veach-mis/scene.pbrt", 12, "matte 6, plastic 4", "area 5", "", 5, 5},
        {"bathroom/scene-hidden-window.pbrt", 449051,
         "glass 1, matte 8, metal 2, mirror 1, plastic 1, substrate 1, uber 7", "area 5",
         "float fbm 1, float scale 1, spectrum imagemap 2", 5},
    };
}

INSTANTIATE_TEST_SUITE_P(Shared, Scenes, testing::ValuesIn(Inventories()), [](const auto& info) {
    std::string name;
    for (const char c : info.param.file) name += std::isalnum(c) ? c : '_';
    return name;
});

TEST(Scenes, MediumIsReadWithVolpath) {
    LULL_SHARED_FILE(file, "pbrt-scenes/coffee-splash/scene-volpath.pbrt");
    Warnings warnings;
    const Description d = ParsePbrt(file.string(), warnings);
    EXPECT_EQ(d.shapes.size(), 9u);
    EXPECT_EQ(d.media.size(), 1u);
    EXPECT_EQ(warnings.Total(), 0);
}

}  // namespace
}  // namespace lull
