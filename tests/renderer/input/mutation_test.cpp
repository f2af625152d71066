// Tests that damaged input is read or refused with an Error, and nothing else: no crash, no other
// exception, no endless loop. The mutations are the same in every run.
#include <functional>
#include <random>

#include "renderer/input/loop_subdivision.h"
#include "renderer/input/pbrt_parser.h"
#include "renderer/input/ply_loader.h"
#include "renderer/input/spectrum.h"
#include "tests/renderer/input/test_files.h"

namespace lull {
namespace {

using Random = std::mt19937;

size_t Below(size_t limit, Random& random) {
    return std::uniform_int_distribution<size_t>(0, std::max<size_t>(limit, 1) - 1)(random);
}

std::string FlipBits(std::string text, Random& random) {
    for (size_t n = 1 + Below(4, random); n > 0 && !text.empty(); --n)
        text[Below(text.size(), random)] ^= char(1 << Below(8, random));
    return text;
}

std::string Truncate(std::string text, Random& random) {
    return text.substr(0, Below(text.size(), random));
}

std::string DeleteSpan(std::string text, Random& random) {
    return text.erase(Below(text.size(), random), 1 + Below(20, random));
}

std::string DuplicateSpan(std::string text, Random& random) {
    const std::string span = text.substr(Below(text.size(), random), 1 + Below(60, random));
    return text.insert(Below(text.size(), random), span);
}

std::string SwapTokens(std::string text, Random& random) {
    std::vector<std::string> tokens;
    for (size_t begin = 0; begin < text.size();) {
        const size_t end = std::min(text.find_first_of(" \n", begin), text.size() - 1) + 1;
        tokens.push_back(text.substr(begin, end - begin));
        begin = end;
    }
    if (tokens.empty()) return text;
    std::swap(tokens[Below(tokens.size(), random)], tokens[Below(tokens.size(), random)]);
    std::string result;
    for (const std::string& token : tokens) result += token;
    return result;
}

// Replaces a number by one that is likely to be mistaken.
std::string ChangeNumber(std::string text, Random& random) {
    const char* const kNumbers[] = {
        "0",          "-1",   "1e38", "-1e-45",     "1e999",
        "nan",        "inf",  "0.5",  "4294967295", "2147483648",
        "3e9",        "-inf", "255",  "1e-300",     "99999999999999999999",
        "-2147483648"};
    const size_t begin = text.find_first_of("0123456789", Below(text.size(), random));
    if (begin == std::string::npos) return text;
    const size_t end = std::min(text.find_first_not_of("0123456789.", begin), text.size());
    return text.replace(begin, end - begin, kNumbers[Below(std::size(kNumbers), random)]);
}

// Feeds `count` mutations of `seed`, one to three deep, to `read`.
void Mutate(const std::string& seed, int count,
            const std::function<void(const std::string&)>& read) {
    using Mutation = std::string (*)(std::string, Random&);
    const Mutation mutations[] = {FlipBits,     DeleteSpan, DuplicateSpan,
                                  ChangeNumber, Truncate,   SwapTokens};
    Random random(20);
    int refused = 0;
    for (int i = 0; i < count; ++i) {
        std::string text = seed;
        for (size_t depth = 1 + Below(3, random); depth > 0; --depth)
            text = mutations[Below(std::size(mutations), random)](text, random);
        try {
            read(text);
        } catch (const Error& error) {
            ++refused;
            EXPECT_STRNE(error.what(), "");
        } catch (const std::exception& other) {
            ADD_FAILURE() << "mutation " << i << " gives " << other.what() << " for\n" << text;
        }
    }
    // Both happen, else the mutations are too weak or too strong to find anything.
    EXPECT_GT(refused, count / 20);
    EXPECT_LT(refused, count);
}

constexpr char kScene[] = R"(LookAt 0 0 -5  0 0 0  0 1 0 # view
Rotate -5 0 0 1
Camera "perspective" "float fov" [39]
Film "image" "integer xresolution" [8] "string filename" "a.exr"
Sampler "random" "integer pixelsamples" 20
PixelFilter "box"
Integrator "path" "integer maxdepth" 5 "bool regularize" false
WorldBegin
CoordSysTransform "camera"
Identity
LightSource "infinite" "blackbody L" [6500 .1] "rgb scale" [1 1 1]
Texture "t" "spectrum" "checkerboard" "xyz tex1" [.1 .2 .3] "color tex2" [0 1 0]
Texture "f" "float" "constant" "float value" .5
MakeNamedMaterial "m" "string type" "matte" "texture Kd" "t" "texture sigma" "f"
MakeNamedMaterial "x" "string type" "mix" "string namedmaterial1" "m" "string namedmaterial2" "m"
AttributeBegin
  Translate 1 2 3 Scale .5 .5 .5 ReverseOrientation
  ConcatTransform [1 0 0 0 0 1 0 0 0 0 1 0 2 3 4 1]
  AreaLightSource "diffuse" "spectrum L" [400 1 500 2 600 .5]
  NamedMaterial "x"
  Shape "trianglemesh" "integer indices" [0 1 2 2 3 0] "normal N" [0 0 1 0 0 1 0 0 1 0 0 1]
    "point P" [-1 -1 0 1 -1 0 1 1 0 -1 1 0] "point2 st" [0 0 1 0 1 1 0 1]
AttributeEnd
ObjectBegin "o"
  Material "metal" "spectrum eta" "flat.spd"
  Shape "loopsubdiv" "integer nlevels" 1 "integer indices" [0 2 1 0 1 3 1 2 3 0 3 2]
    "point P" [0 0 0 1 0 0 0 1 0 0 0 1]
ObjectEnd
TransformBegin
  Transform [1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1]
  ObjectInstance "o"
TransformEnd
Include "part.pbrt"
WorldEnd
)";

// Takes what a scene file says, as far as this layer goes.
void ReadScene(const std::string& file) {
    Warnings warnings;
    const Description d = ParsePbrt(file, warnings);
    for (const ObjectEntity& object : d.objects)
        for (const ShapeEntity& shape : object.shapes)
            if (shape.name == "loopsubdiv" && shape.parameters.GetInt("nlevels", 3) < 6)
                LoopSubdivide(shape.parameters.GetFloats(ParameterType::Point3, "P"),
                              shape.parameters.GetInts("indices"),
                              shape.parameters.GetInt("nlevels", 3), shape.loc);
}

TEST(Mutations, PbrtScenes) {
    const TestFolder folder;
    folder.Write("flat.spd", "400 1\n700 1\n");
    folder.Write("part.pbrt", "Shape \"sphere\" \"float radius\" [2]\n");
    ReadScene(folder.Write("seed.pbrt", kScene));
    Mutate(kScene, 4000,
           [&](const std::string& text) { ReadScene(folder.Write("mutant.pbrt", text)); });
}

void MutatePly(const std::string& seed) {
    const TestFolder folder;
    Warnings warnings;
    LoadPly(folder.Write("seed.ply", seed), warnings);
    Mutate(seed, 1500,
           [&](const std::string& text) { LoadPly(folder.Write("mutant.ply", text), warnings); });
}

constexpr char kPlyHeader[] =
    "comment x\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n"
    "property float nx\nproperty float ny\nproperty float nz\nproperty float u\nproperty float v\n"
    "element face 3\nproperty list uchar int vertex_indices\nelement edge 1\nproperty int a\n"
    "end_header\n";

TEST(Mutations, AsciiPly) {
    MutatePly(std::string("ply\nformat ascii 1.0\n") + kPlyHeader +
              "0 0 0 0 0 1 0 0\n1 0 0 0 0 1 1 0\n1 1 0 0 0 1 1 1\n0 1 0 0 0 1 0 1\n"
              "3 0 1 2\n4 0 1 2 3\n3 2 3 0\n7\n");
}

std::string BinaryPly(const std::string& format, bool swap) {
    std::string text = "ply\nformat " + format + " 1.0\n" + kPlyHeader;
    const auto put = [&](auto value) {
        std::string bytes(reinterpret_cast<const char*>(&value), sizeof(value));
        if (swap) std::reverse(bytes.begin(), bytes.end());
        text += bytes;
    };
    for (int i = 0; i < 4; ++i)
        for (int j = 0; j < 8; ++j) put(float(i * j));
    for (int i = 0; i < 3; ++i) {
        text += char(i == 1 ? 4 : 3);
        for (int j = 0; j < (i == 1 ? 4 : 3); ++j) put(j);
    }
    put(7);
    return text;
}

TEST(Mutations, LittleEndianPly) { MutatePly(BinaryPly("binary_little_endian", false)); }
TEST(Mutations, BigEndianPly) { MutatePly(BinaryPly("binary_big_endian", true)); }

TEST(Mutations, SpectrumFiles) {
    const TestFolder folder;
    Mutate("# silver\n298.757050 1.080000\n302.400421 0.882000\n306.133759, 0.761063 # end\n", 1500,
           [&](const std::string& text) { LoadSpectrum(folder.Write("mutant.spd", text)); });
}

// Any triangles over few vertices: most are no manifold.
TEST(Mutations, LoopSubdivisionOfAnyFaces) {
    Random random(20);
    int refused = 0;
    const std::vector<float> p = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 1, 1, 1, 2, 0, 1};
    for (int i = 0; i < 3000; ++i) {
        std::vector<int> faces(3 * (1 + Below(6, random)));
        for (int& index : faces) index = int(Below(6, random));
        try {
            LoopSubdivide(p, faces, int(Below(3, random)), {});
        } catch (const Error&) {
            ++refused;
        }
    }
    EXPECT_GT(refused, 1000);
    EXPECT_LT(refused, 3000);
}

}  // namespace
}  // namespace lull
