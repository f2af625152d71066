// Gives the program scenes and files that are broken: it must say what is wrong and where, with
// exit code 1, and leave all files as they are.
#include <algorithm>

#include "tests/integration/run_lull.h"

namespace lull {
namespace {

constexpr const char* kRender = "render scene.pbrt -o out.exr --spp 2";

// All that pbrt-v3 reports and goes on without.
TEST(BadInput, WithSubstitutesIsRendered) {
    const TemporaryDirectory directory;
    const std::string world =
        "NamedMaterial \"none\"\nMaterial \"velvet\"\nMaterial \"matte\" \"texture Kd\" \"lost\"\n"
        "Texture \"t\" \"color\" \"imagemap\" \"string filename\" \"lost.png\"\n"
        "Shape \"plymesh\" \"string filename\" \"lost.ply\"\nObjectInstance \"lost\"\n"
        "CoordSysTransform \"lost\"\nShape \"blob\"\nLightSource \"glow\"\n"
        "LightSource \"infinite\" \"string mapname\" \"lost.exr\"\n"
        "Material \"metal\" \"spectrum k\" \"lost.spd\"\n";
    directory.Write("scene.pbrt", SceneText(world + "Include \"lost.pbrt\"\n" + kSphere));
    const std::string command = "render scene.pbrt --spp 2 -o a.exr";
    const Outcome with = ExpectSuccess(directory, command + " --substitute");
    for (const char* lost :
         {"NamedMaterial \"none\"", "\"velvet\"", "there is no texture \"lost\"", "lost.png",
          "lost.ply", "ObjectInstance of \"lost\"", "coordinate system \"lost\"", "\"blob\"",
          "\"glow\"", "lost.exr", "lost.spd", "lost.pbrt"})
        EXPECT_HAS(with.err, lost);

    directory.Write("scene.pbrt", SceneText(world + kSphere));
    const Outcome without = RunLull(directory, command);
    EXPECT_EQ(without.exitCode, 1);
    EXPECT_EQ(CountErrorLines(without.err), 11) << without.err;
    EXPECT_HAS(without.err,
               "scene.pbrt:7: NamedMaterial \"none\": no MakeNamedMaterial in "
               "force defines it; with --substitute ");
}

TEST(BadInput, IsToldAllAtOnce) {
    const TemporaryDirectory directory;
    directory.Write("scene.pbrt", SceneText("Scale 0 1 1\nShape \"sphere\" \"float radius\" [x]\n"
                                            "Material \"matte\"\nShapes \"sphere\""));
    const Outcome outcome = RunLull(directory, kRender);
    EXPECT_EQ(outcome.exitCode, 1);
    EXPECT_EQ(CountErrorLines(outcome.err), 3) << outcome.err;
    for (const char* place : {"scene.pbrt:7: Scale by 0",
                              "scene.pbrt:8: ", "scene.pbrt:10: unknown directive 'Shapes'"})
        EXPECT_HAS(outcome.err, place);
}

TEST(BadInput, OfOtherProgramsIsNamed) {
    using namespace std::string_literals;
    const TemporaryDirectory directory;
    const std::pair<std::string, const char*> kFiles[] = {
        {"BLENDER-v300"s + std::string(100, '\0'), "it is a Blender file"},
        {"\x28\xb5\x2f\xfd\1\2\3"s, "it is compressed (zstd), as Blender's files are"},
        {"\x89PNG\r\n\x1a\n"s, "it is a PNG image"},
        {"some\0thing"s, "it is a binary file"},
        {"SurfaceIntegrator \"path\"\n",
         "written for pbrt-v2, as its directive SurfaceIntegrator shows"}};
    for (const auto& [text, message] : kFiles) {
        directory.Write("scene.pbrt", text);
        ExpectFailure(directory, kRender, {message});
    }
}

// Returns a scene with a texture that a file has.
std::string TexturedScene(const std::string& file) {
    return SceneText(
        fmt::format("Texture \"t\" \"spectrum\" \"imagemap\" \"string filename\" \"{}\"\n"
                    "Material \"matte\" \"texture Kd\" \"t\"\n{}",
                    file, kSphere));
}

// What a reader of each kind of file says has the place in the scene and the name of the file.
TEST(BadInput, IsNamedWithItsPlace) {
    const TemporaryDirectory directory;
    std::filesystem::create_directory(directory.File("folder.pbrt"));
    std::filesystem::create_directory(directory.File("folder.exr"));
    directory.Write("scene.pbrt", SceneText(kSphere));
    directory.Write("line.pbrt", SceneText("\nShapely \"sphere\""));
    directory.Write("kind.pbrt", SceneText("Shape \"blob\""));
    directory.Write("film.pbrt", SceneText(kSphere, "\"integer xresolution\" [2000000000]"));
    directory.Write("value.pbrt",
                    SceneText("Material \"uber\" \"float eta\" [-1]\nShape \"sphere\""));
    directory.Write("mesh.pbrt", SceneText("Shape \"plymesh\" \"string filename\" \"m.ply\""));
    directory.Write("m.ply", "ply\nformat ascii 1.0\nelement vertex 3\n");
    directory.Write("texture.pbrt", TexturedScene("image.png"));
    directory.Write("image.png", "\x89PNG but not for long");
    directory.Write(
        "lens.pbrt",
        "Camera \"realistic\" \"string lensfile\" \"lens.dat\"\nWorldBegin\nWorldEnd\n");
    directory.Write("lens.dat", "1 2 3");
    directory.Write("scene.gltf", "{}");
    directory.Write("words.csv", "scene;twenty;\n");
    directory.Write("many.csv", "scene;20;40;60;80;\n");  // the image has one block
    directory.Write("model.h5", "not HDF5 at all");
    const std::pair<const char*, std::vector<std::string>> cases[] = {
        {"gone.pbrt", {"gone.pbrt"}},
        {"folder.pbrt", {"folder.pbrt"}},
        {"line.pbrt", {"line.pbrt:8", "Shapely"}},
        {"kind.pbrt", {"kind.pbrt:7", "blob"}},
        {"film.pbrt", {"film.pbrt:3"}},
        {"value.pbrt", {"value.pbrt:7", "\"eta\" of material \"uber\"", "-1"}},
        {"mesh.pbrt", {"m.ply"}},
        {"texture.pbrt", {"texture.pbrt:7", "image.png"}},
        {"lens.pbrt", {"lens.dat"}},
        {"scene.gltf", {"scene.gltf"}},
        {"scene.pbrt --stop thresholds:words.csv:scene", {"words.csv:1"}},
        {"scene.pbrt --stop thresholds:many.csv:scene", {"many.csv"}},
        {"scene.pbrt --stop learned:model.h5", {"model.h5"}},
        {"scene.pbrt --stop learned:gone", {"gone", "entropy, paper"}},
        {"scene.pbrt --report nowhere/r.json", {"nowhere"}}};
    for (const auto& [arguments, parts] : cases)
        ExpectFailure(directory, fmt::format("render {} -o out.exr", arguments), parts);
    for (const char* output : {"folder.exr", "nowhere/out.exr"})
        ExpectFailure(directory, fmt::format("render scene.pbrt --spp 2 -o {}", output),
                      {std::filesystem::path(output).begin()->string()});
}

// What OpenImageIO says comes in several lines.
TEST(BadInput, ErrorsOfOtherFormatsAreOneLine) {
    const TemporaryDirectory directory;
    directory.Write("t.tif", std::string("II*\0\x08\0\0\0\xff\xff", 10) + std::string(60, 'x'));
    directory.Write("t.gif", "GIF89a" + std::string(30, 'x'));
    directory.Write("t.webp", "RIFF\x10xxxWEBPVP8 " + std::string(30, 'x'));
    directory.Write("t.jp2", std::string("\0\0\0\x0cjP  \r\n\x87\n", 12) + std::string(60, 'x'));
    for (const char* name : {"t.tif", "t.gif", "t.webp", "t.jp2"}) {
        directory.Write("scene.pbrt", TexturedScene(name));
        const Outcome outcome = ExpectFailure(directory, kRender, {"scene.pbrt:7", name});
        EXPECT_EQ(std::ranges::count(outcome.err, '\n'), 1) << outcome.err;
    }
}

TEST(BadInput, ImageTooLargeForTheMemory) {
    const SceneDirectory directory;
    const Outcome outcome = RunShell(directory,
                                     "ulimit -v 4000000 && LULL render scene.pbrt -o out.exr "
                                     "--resolution 13000x13000 --spp 1");
    EXPECT_EQ(outcome.exitCode, 1) << outcome.err;
    EXPECT_EQ(CountErrorLines(outcome.err), 1) << outcome.err;
    EXPECT_HAS(outcome.err, "an image of 13000x13000 pixels needs 4.1 GB of memory");
    EXPECT_HAS(outcome.err, "--crop");
}

}  // namespace
}  // namespace lull
