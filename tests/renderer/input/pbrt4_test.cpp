// Tests that scenes for pbrt-v4 are told from those for pbrt-v3, and what becomes of their
// directives and errors.
#include <fmt/format.h>

#include <fstream>

#include "renderer/input/pbrt/pbrt_lexer.h"
#include "renderer/input/pbrt/v4.h"
#include "tests/renderer/input/test_files.h"
#include "tests/shared_folder.h"

namespace lull {
namespace {

class Pbrt4 : public testing::Test {
  protected:
    Description ParseV4(const std::string& world, Warnings* warnings = nullptr) {
        return folder.Parse("Film \"rgb\"\nWorldBegin\n" + world + "\n", warnings);
    }
    // Puts `text` on the third line, inside the world.
    void ExpectError(const std::string& text, const std::string& message) {
        const std::string found = folder.ErrorOf("Film \"rgb\"\nWorldBegin\n" + text + "\n");
        EXPECT_TRUE(found.starts_with("scene.pbrt:3: " + message))
            << "in    " << text << "\nfound " << found << "\nnot   " << message;
    }

    // Returns the message of the Error that a file gives, "" for none.
    std::string ErrorIn(const std::string& path) {
        Warnings warnings;
        return folder.MessageOf([&] {
            ParsePbrt(path, warnings);
            warnings.ThrowErrors();
        });
    }

    TestFolder folder;
};

TEST_F(Pbrt4, VersionIsTold) {
    const auto version = [&](const std::string& text) {
        Warnings warnings;
        PbrtLexer lexer(folder.Write("scene.pbrt", text));
        return DetectPbrtVersion(folder.path.string(), &lexer, warnings);
    };
    for (const char* text :
         {"Film \"image\"\nWorldBegin", "WorldBegin\nMaterial \"matte\"\nWorldEnd",
          "WorldBegin\nMakeNamedMaterial \"a\" \"string type\" \"uber\"",
          "WorldBegin\nMaterial \"mix\" \"rgb Kd\" [1 1 1]",
          "PixelFilter \"box\" \"float xwidth\" 1\nWorldBegin",
          "WorldBegin\nShape \"sphere\"\nWorldEnd", "Shape"})
        EXPECT_EQ(version(text), PbrtVersion::V3) << text;
    for (const char* text :
         {"Film \"rgb\"\nWorldBegin\nWorldEnd", "Option \"seed\" 1\nFilm \"image\"",
          "WorldBegin\nAttribute \"shape\" \"float alpha\" 1", "WorldBegin\nMaterial \"diffuse\"",
          "WorldBegin\nMakeNamedMaterial \"a\" \"string type\" [ \"coateddiffuse\" ]",
          "WorldBegin\nMaterial \"mix\" \"rgb reflectance\" [1 1 1]",
          "WorldBegin\nShape \"sphere\"", "Sampler \"zsobol\"\nWorldBegin\nWorldEnd"})
        EXPECT_EQ(version(text), PbrtVersion::V4) << text;
    folder.Write("included.pbrt", "Material \"dielectric\"");
    EXPECT_EQ(version("WorldBegin\nInclude \"included.pbrt\"\nWorldEnd"), PbrtVersion::V4);
    EXPECT_TRUE(
        folder.ErrorOf("\nSurfaceIntegrator \"path\"").starts_with("scene.pbrt:2: this scene is"));
}

TEST_F(Pbrt4, Defaults) {
    const Description d = ParseV4("Shape \"sphere\"");
    EXPECT_EQ(d.integrator.name, "volpath");
    EXPECT_EQ(d.integrator.parameters.GetInt("maxdepth", 0), 5);
    EXPECT_EQ(d.sampler.parameters.GetInt("pixelsamples", 0), 16);
    EXPECT_EQ(d.filter.name, "gaussian");
    EXPECT_EQ(d.filter.parameters.GetFloat("alpha", 0), 2);  // 1 / (2 sigma^2)
    EXPECT_EQ(d.filter.parameters.GetFloat("xwidth", 0), 1.5f);
    EXPECT_EQ(d.film.parameters.GetString("filename", ""), "pbrt.exr");
    ASSERT_EQ(d.shapes.size(), 1u);
    EXPECT_EQ(d.materials[size_t(d.shapes[0].material)].name, "matte");
}

TEST_F(Pbrt4, LargeMeshesAreNotCopied) {
    Description description;
    Warnings warnings;
    const GraphicsState state;
    Entity mesh{"trianglemesh", {}, {}};
    mesh.parameters.Add({ParameterType::Point3, "P", {}, std::vector<float>(9)});
    const float* values = mesh.parameters.GetFloats(ParameterType::Point3, "P").data();
    const Entity shape =
        TranslateV4({EntityKind::Shape, description, state, warnings}, std::move(mesh));
    EXPECT_EQ(shape.parameters.GetFloats(ParameterType::Point3, "P").data(), values);
    EXPECT_EQ(shape.parameters.GetInts("indices").size(), 3u);
}

// TransformEnd takes back everything; names are known from then on everywhere.
TEST_F(Pbrt4, ScopesAndNames) {
    const Description d = ParseV4(
        "TransformBegin\nMaterial \"conductor\"\n"
        "MakeNamedMaterial \"a\" \"string type\" \"dielectric\"\nTransformEnd\n"
        "Shape \"sphere\"\nNamedMaterial \"a\"\nShape \"sphere\"");
    ASSERT_EQ(d.shapes.size(), 2u);
    EXPECT_EQ(d.materials[size_t(d.shapes[0].material)].name, "matte");
    EXPECT_EQ(d.materials[size_t(d.shapes[1].material)].name, "glass");
}

TEST_F(Pbrt4, ImportLeaksNoState) {
    folder.Write("part.pbrt",
                 "Translate 1 0 0\nMaterial \"dielectric\"\nShape \"sphere\"\n"
                 "MakeNamedMaterial \"m\" \"string type\" \"conductor\"\n");
    const Description d =
        ParseV4("Import \"part.pbrt\"\nShape \"sphere\"\nNamedMaterial \"m\"\nShape \"sphere\"");
    ASSERT_EQ(d.shapes.size(), 3u);
    EXPECT_EQ(d.shapes[0].worldFromObject(0, 3), 1);
    EXPECT_EQ(d.shapes[1].worldFromObject(0, 3), 0);
    EXPECT_EQ(d.materials[size_t(d.shapes[1].material)].name, "matte");
    EXPECT_EQ(d.materials[size_t(d.shapes[2].material)].name, "metal");
}

TEST_F(Pbrt4, AttributesAreDefaults) {
    const Description d = ParseV4(
        "AttributeBegin\nAttribute \"light\" \"float scale\" 2 \"float power\" 3\n"
        "LightSource \"distant\"\nLightSource \"distant\" \"float scale\" 5\nAttributeEnd\n"
        "LightSource \"distant\"");
    ASSERT_EQ(d.lights.size(), 3u);
    for (const auto& [light, L] : {std::pair(0, 2.f), {1, 5.f}, {2, 1.f}})
        EXPECT_EQ(d.lights[size_t(light)].parameters.GetSpectrum("L", Rgb::Zero()).x(), L);
}

TEST_F(Pbrt4, UnclosedFileIsRead) {
    Warnings warnings;
    EXPECT_EQ(ParseV4("AttributeBegin\nShape \"sphere\"", &warnings).shapes.size(), 1u);
    EXPECT_EQ(warnings.Total(), 1);
}

TEST_F(Pbrt4, Errors) {
    ExpectError("Material \"matte\"",
                "Material \"matte\" is pbrt-v3's, in a scene for pbrt-v4; write \"diffuse\"");
    ExpectError("Material \"diffuse\" \"color reflectance\" [1 1 1]",
                "parameter type \"color\" is pbrt-v3's");
    ExpectError("Texture \"t\" \"color\" \"constant\"", "texture kind \"color\" is unknown");
    ExpectError("Material \"diffuse\" \"rgb reflectance\" [1 2 1]",
                "\"rgb reflectance\" has a part above 1");
    ExpectError("Material \"diffuse\" \"rgb reflectance\" [1 -1 1]",
                "the colour of \"rgb reflectance\" has a part below 0");
    ExpectError("Material \"diffuse\" \"rgb reflectence\" [1 1 1]",
                "material \"diffuse\" has no parameter \"rgb reflectence\" in pbrt-v4");
    ExpectError("Material \"diffuse\" \"float reflectance\" 1",
                "material \"diffuse\" has no parameter \"float reflectance\"");
    ExpectError("Material \"measured\" \"string filename\" \"a.bsdf\"",
                "material \"measured\" is not supported");
    ExpectError("Shape \"cone\"", "Shape \"cone\" is not supported in pbrt-v4");
    ExpectError("Shape \"loopsubdiv\" \"integer levels\" 1.5",
                "parameter \"integer levels\" has a number with a fraction");
    ExpectError("LightSource \"infinite\" \"string filename\" \"a.exr\" \"rgb L\" [1 1 1]",
                "an infinite light has \"L\" or \"filename\"");
    ExpectError("Attribute \"camera\" \"float fov\" 1", "Attribute \"camera\" is unknown");
    ExpectError("ColorSpace \"adobe\"", "ColorSpace \"adobe\" is unknown");
    const std::string medium = "MakeNamedMedium \"m\" \"string type\" ";
    ExpectError(medium + "\"smoke\"", "medium \"smoke\" is unknown; cloud, homogeneous, nanovdb");
    ExpectError(medium + "\"rgbgrid\" \"rgb Le\" [1 1 1] \"rgb sigma_s\" [1 1 1]",
                "medium \"rgbgrid\" needs \"rgb sigma_a\"");
    ExpectError(medium + "\"nanovdb\"", "medium \"nanovdb\" needs \"string filename\"");
    ExpectError(medium + "\"cloud\" \"float scale\" 2",
                "medium \"cloud\" has no parameter \"float scale\"");
    ExpectError(medium + "\"uniformgrid\" \"rgb Le\" [1 1 1] \"float temperature\" [1]",
                "medium \"uniformgrid\" has both \"Le\" and \"temperature\"");
    ExpectError("Material \"coateddiffuse\" \"spectrum albedo\" [400 1 700 1]",
                "a coat whose layer scatters");
    ExpectError("Texture \"t\" \"float\" \"constant\" Texture \"t\" \"float\" \"constant\"",
                "texture \"t\" is there already");
    ExpectError("Material \"dielectric\" \"spectrum eta\" \"stdillum-A\"",
                "the spectrum \"stdillum-A\" is none of a glass");
    ExpectError("MakeNamedMaterial \"Water\" \"string type\" \"dielectric\" Material \"Water\"",
                "\"Water\" is the name of a material; write NamedMaterial");
    EXPECT_TRUE(folder.ErrorOf("Film \"rgb\"\nSampler \"random\"\nWorldBegin")
                    .starts_with("scene.pbrt:2: Sampler \"random\" is pbrt-v3's, in a scene for "
                                 "pbrt-v4; write \"independent\""));
}

TEST_F(Pbrt4, PatchesBecomeTriangles) {
    const auto triangles = [&](const char* last) {
        const Description d = ParseV4(
            fmt::format("Shape \"bilinearmesh\" \"point3 P\" [0 0 0  1 0 0  0 1 0  1 1 {}]", last));
        return d.shapes[0].parameters.GetInts("indices").size() / 3;
    };
    EXPECT_EQ(triangles("0"), 2u);
    EXPECT_EQ(triangles(".5"), 128u);
}

// Values of the tables in pbrt-v4's source, by the CIE's observer.
TEST_F(Pbrt4, NamedSpectra) {
    LULL_SHARED_FILE(table, "pbrt4/spectra.csv");
    std::ifstream file(table);
    std::string line;
    std::getline(file, line);
    int lights = 0, metals = 0;
    while (std::getline(file, line)) {
        const size_t first = line.find(','), second = line.find(',', first + 1);
        const std::string kind = line.substr(0, first);
        const std::string name = line.substr(first + 1, second - first - 1);
        std::vector<float> v;
        for (size_t at = second; at != line.npos; at = line.find(',', at + 1))
            v.push_back(std::stof(line.substr(at + 1)));
        const auto expect = [&](const Rgb& found, size_t from, float tolerance) {
            for (size_t c = 0; c < 3; ++c)
                EXPECT_NEAR(found[int(c)], std::max(0.f, v[from + c]), tolerance) << line;
        };
        if (kind == "blackbody") {
            expect(RgbOfLight(BlackbodySpectrum{std::stof(name)}, {}), 0, 2e-3f);
            ++lights;
        } else if (kind == "light") {
            expect(RgbOfLight(NamedSpectrum{name}, {}), 0, 1e-5f);
            ++lights;
        } else if (kind == "metal") {
            const auto [eta, k] = RgbOfConductor(NamedSpectrum{"metal-" + name + "-eta"},
                                                 NamedSpectrum{"metal-" + name + "-k"}, {});
            const Rgb f = ((eta - 1).square() + k.square()) / ((eta + 1).square() + k.square());
            expect(f, 6, 1e-4f);
            ++metals;
        }
    }
    EXPECT_EQ(lights, 31);
    EXPECT_EQ(metals, 7);
}

TEST_F(Pbrt4, SampledSpectra) {
    const auto samples = [](std::vector<float> v) { return SampledSpectrumOf(v, {}); };
    const Rgb light = RgbOfLight(samples({400, 50, 500, 50, 600, 50, 700, 50}), {});
    EXPECT_NEAR(light.x(), 1.201f, 2e-3f);
    EXPECT_NEAR(light.z(), .905f, 2e-3f);
    // A constant reflectance is grey; outside of the samples it is 0.
    EXPECT_LT((RgbOfSurface(samples({300, .5f, 900, .5f}), {}) - .5f).abs().maxCoeff(), 1e-4f);
    EXPECT_LT(RgbOfSurface(samples({300, .5f, 400, .5f}), {}).maxCoeff(), .05f);
    EXPECT_NEAR(IndexOf(samples({400, 1.5f, 700, 1.6f}), {}), 1.5f + .1f * 187.6f / 300, 1e-4f);
    EXPECT_THROW(samples({500, 1, 400, 1}), Error);
}

TEST_F(Pbrt4, WhiteBalance) {
    const Mat3f m = WhiteBalance(5000);
    const float rows[] = {.9392f,  -.0942f, -.0175f, .0045f, 1.0243f,
                          -.0065f, .0081f,  .0295f,  1.3318f};
    for (int i = 0; i < 9; ++i) EXPECT_NEAR(m(i / 3, i % 3), rows[i], 3e-3f) << i;
    EXPECT_NEAR(WhiteBalance(3200)(2, 2), 2.5274f, .02f);
}

// All whole scenes of others are read; what they ask for and lull has not is named.
TEST_F(Pbrt4, ScenesOfOthers) {
    LULL_SHARED_FILE(root, "pbrt4-scenes");
    int read = 0, refused = 0;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(root)) {
        const std::string path = entry.path().string();
        if (entry.path().extension() != ".pbrt" || path.find("/broken/") != path.npos) continue;
        std::ifstream file(entry.path());
        const std::string text{std::istreambuf_iterator<char>(file), {}};
        if (text.find("WorldBegin") == text.npos) continue;  // a part of another
        const std::string error = ErrorIn(path);
        ++read;
        refused += !error.empty();
        EXPECT_TRUE(error.empty() || error.find("not supported") != error.npos) << error;
    }
    EXPECT_GE(read, 150);
    EXPECT_LE(refused, 6);
}

TEST_F(Pbrt4, FilesThatPeopleGetWrong) {
    LULL_SHARED_FILE(root, "pbrt4-scenes/broken");
    const auto error = [&](const char* name) { return ErrorIn((root / name).string()); };
    EXPECT_HAS(error("half-converted.pbrt"), "half-converted.pbrt:11: Material \"matte\"");
    EXPECT_HAS(error("reflectance-above-one.pbrt"), ":11: \"rgb reflectance\" has a part");
    EXPECT_HAS(error("test-pool.pbrt"), ":12: \"water\" is the name of a material");
    EXPECT_EQ(error("latlong-sky.pbrt"), "");
}

}  // namespace
}  // namespace lull
