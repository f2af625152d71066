// Gives the program scenes and files that are broken: it must say what is wrong and where, with
// exit code 1, and leave all files as they are.
#include <algorithm>

#include "tests/integration/run_lull.h"

namespace lull {
namespace {

constexpr const char* kRender = "render scene.pbrt -o out.exr --spp 2";

void ExpectBadScene(const std::string& text, const std::vector<std::string>& parts) {
    const TemporaryDirectory directory;
    directory.Write("scene.pbrt", text);
    ExpectFailure(directory, kRender, parts);
}

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
        EXPECT_TRUE(Contains(with.err, lost)) << lost << " in: " << with.err;

    directory.Write("scene.pbrt", SceneText(world + kSphere));
    const Outcome without = RunLull(directory, command);
    EXPECT_EQ(without.exitCode, 1);
    EXPECT_EQ(CountErrorLines(without.err), 11) << without.err;
    EXPECT_TRUE(Contains(without.err,
                         "scene.pbrt:7: NamedMaterial \"none\": no MakeNamedMaterial in "
                         "force defines it; with --substitute "))
        << without.err;
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
        EXPECT_TRUE(Contains(outcome.err, place)) << place << " in: " << outcome.err;
}

TEST(BadInput, OfOtherProgramsIsNamed) {
    using namespace std::string_literals;
    const std::pair<std::string, const char*> kFiles[] = {
        {"BLENDER-v300"s + std::string(100, '\0'), "it is a Blender file"},
        {"\x28\xb5\x2f\xfd\1\2\3"s, "it is compressed (zstd), as Blender's files are"},
        {"\x89PNG\r\n\x1a\n"s, "it is a PNG image"},
        {"some\0thing"s, "it is a binary file"},
        {"Film \"rgb\"\nWorldBegin\nMaterial \"matte\"\n",
         "scene.pbrt:3: Material \"matte\" is pbrt-v3's, in a scene for pbrt-v4; write"},
        {"SurfaceIntegrator \"path\"\n",
         "written for pbrt-v2, as its directive SurfaceIntegrator shows"}};
    for (const auto& [text, message] : kFiles) {
        ExpectBadScene(text, {message});
        const TemporaryDirectory directory;
        directory.Write("scene.pbrt", text);
        EXPECT_FALSE(Contains(RunLull(directory, "info scene.pbrt").err, "\\x"));
    }
}

// Rays that Embree takes for invalid, which builds with assertions end the program for.
TEST(BadInput, TooLargeForRays) {
    const TemporaryDirectory directory;
    const auto expect = [&](const std::string& text, const std::vector<std::string>& parts) {
        directory.Write("scene.pbrt", text);
        ExpectFailure(directory, kRender, parts);
    };
    expect(
        "LookAt 0 0 1.9e18 0 0 0 0 1 0\nCamera \"perspective\"\nWorldBegin\nShape \"sphere\"\n"
        "WorldEnd\n",
        {"scene.pbrt:2", "1e+12"});
    expect("Camera \"perspective\" \"float lensradius\" [5e18]\nWorldBegin\nWorldEnd\n",
           {"scene.pbrt:1"});
    expect(SceneText("ObjectBegin \"a\"\nShape \"sphere\"\nObjectEnd\nScale 1e-19 1 1\n"
                     "ObjectInstance \"a\""),
           {"scene.pbrt:11", "changes sizes"});
}

// What OpenImageIO says comes in several lines.
TEST(BadInput, ErrorsOfOtherFormatsAreOneLine) {
    const TemporaryDirectory directory;
    directory.Write("t.tif", std::string("II*\0\x08\0\0\0\xff\xff", 10) + std::string(60, 'x'));
    directory.Write("t.gif", "GIF89a" + std::string(30, 'x'));
    directory.Write("t.webp", "RIFF\x10xxxWEBPVP8 " + std::string(30, 'x'));
    directory.Write("t.jp2", std::string("\0\0\0\x0cjP  \r\n\x87\n", 12) + std::string(60, 'x'));
    for (const char* name : {"t.tif", "t.gif", "t.webp", "t.jp2"}) {
        directory.Write("scene.pbrt",
                        SceneText(fmt::format("Texture \"t\" \"spectrum\" \"imagemap\" \"string "
                                              "filename\" \"{}\"\nMaterial \"matte\" \"texture "
                                              "Kd\" \"t\"\nShape \"sphere\"",
                                              name)));
        ExpectFailure(directory, kRender, {"scene.pbrt:7", name});
        const Outcome outcome = RunLull(directory, kRender);
        EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << outcome.err;
    }
}

TEST(BadInput, LensFilesAreNamed) {
    const TemporaryDirectory directory;
    for (const char* lens : {"1 2 3", "1 2 x 4", "1 1e10 1 1", "1e-3 1 1 1e-30"}) {
        directory.Write("lens.dat", lens);
        directory.Write("scene.pbrt",
                        "Camera \"realistic\" \"string lensfile\" \"lens.dat\"\nWorldBegin\n"
                        "Shape \"sphere\"\nWorldEnd\n");
        ExpectFailure(directory, kRender, {"lens.dat"});
    }
}

TEST(BadInput, GltfScene) {
    const TemporaryDirectory directory;
    directory.Write("scene.gltf", "{}");
    ExpectFailure(directory, "render scene.gltf -o out.exr --spp 2", {"scene.gltf"});
    directory.Write("plain.gltf", "{\"asset\": {\"version\": \"2.0\"}}");
    ExpectFailure(directory, "render plain.gltf -o out.exr --spp 2 --variant red",
                  {"plain.gltf", "has no variant \"red\""});
}

TEST(BadInput, SceneIsNamedWithItsLine) {
    const std::pair<std::string, std::vector<std::string>> cases[] = {
        {SceneText("\nShapely \"sphere\""), {"scene.pbrt:8", "Shapely"}},
        {SceneText("Include \"nowhere.pbrt\""), {"scene.pbrt:7", "nowhere.pbrt"}},
        {SceneText(kSphere, "\"integer xresolution\" [-24]"), {"scene.pbrt:3"}},
        {SceneText(kSphere, "\"integer xresolution\" [0]"), {"scene.pbrt:3"}},
        {SceneText(kSphere, "\"integer xresolution\" [2000000000]"), {"scene.pbrt:3"}},
        {SceneText("Shape \"trianglemesh\" \"integer indices\" [0 1 7] "
                   "\"point P\" [0 0 0 1 0 0 0 1 0]"),
         {"scene.pbrt:7"}},
        {SceneText("Material \"uber\" \"float eta\" [-1]\nShape \"sphere\""),
         {"scene.pbrt:7", "\"eta\" of material \"uber\"", "-1"}},
        {"Integrator \"volpath\"\n" +
             SceneText("MakeNamedMedium \"fog\" \"string type\" \"heterogeneous\"\n"
                       "\"integer nx\" [2] \"float density\" [0 1e30]\n"
                       "\"rgb sigma_a\" [1 1 1] \"rgb sigma_s\" [1 1 1]\n"
                       "MediumInterface \"fog\" \"\"\nMaterial \"\"\nShape \"sphere\""),
         {"scene.pbrt:8", "medium \"fog\" is too dense"}},
    };
    for (const auto& [text, parts] : cases) {
        SCOPED_TRACE(text);
        ExpectBadScene(text, parts);
    }
}

TEST(BadInput, FilesOfScenesAreNamed) {
    const TemporaryDirectory directory;
    directory.Write("scene.pbrt", "");
    ExpectFailure(directory, kRender, {"scene.pbrt"});
    ExpectFailure(directory, "render missing.pbrt -o out.exr", {"missing.pbrt"});
    directory.Write("mesh.ply", "ply\n");
    directory.Write("scene.pbrt", SceneText("Shape \"plymesh\" \"string filename\" \"mesh.ply\""));
    ExpectFailure(directory, kRender, {"mesh.ply"});
    directory.Write("image.png", "\x89PNG but not for long");
    directory.Write("scene.pbrt",
                    SceneText("Texture \"t\" \"spectrum\" \"imagemap\" \"string filename\" "
                              "\"image.png\"\nMaterial \"matte\" \"texture Kd\" \"t\"\n" +
                              std::string(kSphere)));
    ExpectFailure(directory, kRender, {"scene.pbrt:7", "image.png"});
}

TEST(BadInput, DirectoryAsOutput) {
    const TemporaryDirectory directory;
    directory.Write("scene.pbrt", SceneText(kSphere));
    std::filesystem::create_directory(directory.File("folder.exr"));
    ExpectFailure(directory, "render scene.pbrt -o folder.exr --spp 2", {"folder.exr"});
    ExpectFailure(directory, "render scene.pbrt -o nowhere/out.exr --spp 2", {"nowhere"});
    ExpectFailure(directory, "render scene.pbrt -o out.exr --spp 2 --report nowhere/r.json",
                  {"nowhere"});
}

TEST(BadInput, ReportInThePlaceOfAnotherFile) {
    const TemporaryDirectory directory;
    directory.Write("scene.pbrt", SceneText(kSphere));
    for (const char* report : {"out.exr", "./out.png", "scene.pbrt"})
        EXPECT_EQ(RunLull(directory,
                          std::string("render scene.pbrt -o out.exr --spp 2 --report ") + report)
                      .exitCode,
                  2);
    EXPECT_EQ(directory.CountFiles(), 1);
    ExpectFailure(directory,
                  "render scene.pbrt -o out.exr --spp 2 --report r.json --checkpoint ./r.json",
                  {"--report"});
}

TEST(BadInput, BadRules) {
    const TemporaryDirectory directory;
    directory.Write("scene.pbrt", SceneText(kSphere));
    for (const char* rule : {"frogs", "fixed", "fixed:0", "fixed:-3", "fixed:12x", "dammertz:-1",
                             "dammertz:nan", "cycles:", "''"})
        ExpectFailure(directory, std::string("render scene.pbrt -o out.exr --stop ") + rule,
                      {"--stop"}, 2);
}

TEST(BadInput, BadThresholdsFile) {
    const TemporaryDirectory directory;
    directory.Write("scene.pbrt", SceneText(kSphere));
    auto fail = [&](const std::string& file, const std::vector<std::string>& parts) {
        ExpectFailure(directory, "render scene.pbrt -o out.exr --stop thresholds:" + file, parts);
    };
    fail("gone.csv", {"gone.csv"});
    directory.Write("words.csv", "scene;twenty;\n");
    fail("words.csv:scene", {"words.csv:1"});
    directory.Write("other.csv", "elsewhere;20;\n");
    fail("other.csv:scene", {"scene"});
    directory.Write("many.csv", "scene;20;40;60;80;\n");  // the image has one block
    fail("many.csv:scene", {"many.csv"});
}

TEST(BadInput, BadModelFile) {
    const TemporaryDirectory directory;
    directory.Write("scene.pbrt", SceneText(kSphere));
    directory.Write("model.h5", "not HDF5 at all");
    ExpectFailure(directory, "render scene.pbrt -o out.exr --stop learned:model.h5", {"model.h5"});
    ExpectFailure(directory, "render scene.pbrt -o out.exr --stop learned:gone.h5", {"gone.h5"});
    ExpectFailure(directory, "render scene.pbrt -o out.exr --stop learned:gone",
                  {"gone", "entropy, paper"});
    ExpectFailure(directory, "render scene.pbrt -o out.exr --stop dammertz --caution 2",
                  {"caution", "entropy, lnoise"}, 2);
}

// What is broken but harmless is counted, not refused.
TEST(BadInput, BrokenTrianglesAreLeftOut) {
    const TemporaryDirectory directory;
    directory.Write("scene.pbrt",
                    SceneText("AreaLightSource \"diffuse\"\nShape \"trianglemesh\" \"integer "
                              "indices\" [0 1 2] \"point P\" [0 0 0 1 1 1 2 2 2]\n" +
                              std::string(kSphere)));
    const Outcome outcome = ExpectSuccess(directory, kRender);
    EXPECT_TRUE(Contains(outcome.err, "warning")) << outcome.err;
}

// The limit on the size of files stands in for a full disk: every write beyond it fails.
TEST(BadInput, ImageTooLargeForTheMemory) {
    const TemporaryDirectory directory;
    directory.Write("scene.pbrt", SceneText(kSphere));
    const Outcome outcome = RunShell(directory,
                                     "ulimit -v 4000000 && LULL render scene.pbrt -o out.exr "
                                     "--resolution 13000x13000 --spp 1");
    EXPECT_EQ(outcome.exitCode, 1) << outcome.err;
    EXPECT_EQ(CountErrorLines(outcome.err), 1) << outcome.err;
    EXPECT_TRUE(Contains(outcome.err, "an image of 13000x13000 pixels needs 4.1 GB of memory"))
        << outcome.err;
    EXPECT_TRUE(Contains(outcome.err, "--crop")) << outcome.err;
}

TEST(BadInput, FullDisk) {
    const TemporaryDirectory directory;
    directory.Write("scene.pbrt", SceneText(kSphere));
    directory.Write("out.exr", "precious");
    const Outcome outcome = RunShell(
        directory, "trap '' XFSZ; ulimit -f 1; LULL render scene.pbrt -o out.exr --spp 1 --quiet");
    EXPECT_EQ(outcome.exitCode, 1) << outcome.err;
    EXPECT_EQ(CountErrorLines(outcome.err), 1) << outcome.err;
    EXPECT_TRUE(Contains(outcome.err, "out.")) << outcome.err;
    EXPECT_EQ(ReadBytes(directory.File("out.exr")), "precious");
}

}  // namespace
}  // namespace lull
