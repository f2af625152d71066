#include "renderer/input/ply_loader.h"

#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>
#include <cstring>

#include "tests/renderer/input/test_files.h"

namespace lull {
namespace {

// Writes values as a PLY body in any of the three encodings.
class PlyWriter {
  public:
    explicit PlyWriter(const std::string& format)
        : isAscii(format == "ascii"), isSwapped(format == "binary_big_endian") {
        text = "ply\nformat " + format + " 1.0\ncomment made by a test\n";
    }
    PlyWriter& Header(const std::string& lines) {
        text += lines + "end_header\n";
        return *this;
    }
    template <typename T>
    PlyWriter& Put(std::initializer_list<double> values) {
        for (const double value : values) {
            if (isAscii) {
                text += std::to_string(value) + " ";
                continue;
            }
            const T typed = T(value);
            std::string bytes(sizeof(T), '\0');
            std::memcpy(bytes.data(), &typed, sizeof(T));
            if (isSwapped) std::reverse(bytes.begin(), bytes.end());
            text += bytes;
        }
        if (isAscii) text += "\n";
        return *this;
    }

    std::string text;

  private:
    bool isAscii, isSwapped;
};

constexpr const char* kFormats[] = {"ascii", "binary_little_endian", "binary_big_endian"};

std::string Gzip(const std::string& text) {
    z_stream z{};
    deflateInit2(&z, 9, Z_DEFLATED, 15 + 16, 8, Z_DEFAULT_STRATEGY);
    std::string packed(deflateBound(&z, text.size()), '\0');
    z.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(text.data()));
    z.avail_in = uInt(text.size());
    z.next_out = reinterpret_cast<Bytef*>(packed.data());
    z.avail_out = uInt(packed.size());
    deflate(&z, Z_FINISH);
    packed.resize(z.total_out);
    deflateEnd(&z);
    return packed;
}

class Ply : public testing::Test {
  protected:
    MeshData Load(const std::string& contents) {
        return LoadPly(folder.Write("a.ply", contents), warnings);
    }
    std::string ErrorOf(const std::string& contents) {
        return folder.MessageOf([&] { Load(contents); });
    }

    TestFolder folder;
    Warnings warnings;
};

using Triangle = std::array<uint32_t, 3>;

const std::string kPositions = "property float x\nproperty float y\nproperty float z\n";
const std::string kNormals = "property float nx\nproperty float ny\nproperty float nz\n";
const std::string kFaces = "property list uchar int vertex_indices\n";

// Returns a triangle and its vertices, which the error tests then damage.
std::string Header(const std::string& vertices, const std::string& faces,
                   const std::string& properties = "") {
    return "element vertex " + vertices + "\n" + kPositions + properties + "element face " + faces +
           "\n" + kFaces;
}

TEST_F(Ply, TrianglesInEveryEncodingPlainAndPacked) {
    for (const std::string format : kFormats) {
        PlyWriter ply(format);
        ply.Header(Header("3", "2"));
        ply.Put<float>({0, 0, 0}).Put<float>({1, 0, 0}).Put<float>({0, 2, .5});
        ply.Put<uint8_t>({3}).Put<int>({0, 1, 2}).Put<uint8_t>({3}).Put<int>({2, 1, 0});
        for (const std::string& contents : {ply.text, Gzip(ply.text)}) {
            const MeshData mesh = Load(contents);
            ASSERT_EQ(mesh.positions.size(), 3u) << format;
            EXPECT_EQ(mesh.positions[2], Vec3f(0, 2, .5f));
            EXPECT_EQ(mesh.triangles, (std::vector<Triangle>{{0, 1, 2}, {2, 1, 0}}));
            EXPECT_TRUE(mesh.normals.empty() && mesh.uvs.empty() && mesh.faceIndices.empty());
        }
    }
    EXPECT_EQ(warnings.Total(), 0);
}

TEST_F(Ply, PolygonsAreDivided) {
    for (const std::string format : kFormats) {
        PlyWriter ply(format);
        ply.Header(Header("5", "5") + "property int face_indices\n");
        for (int i = 0; i < 5; ++i) ply.Put<float>({double(i), 0, 0});
        ply.Put<uint8_t>({4}).Put<int>({0, 1, 2, 3, 70});
        ply.Put<uint8_t>({5}).Put<int>({0, 1, 2, 3, 4, 71});
        ply.Put<uint8_t>({2}).Put<int>({0, 1, 72});
        ply.Put<uint8_t>({3}).Put<int>({4, 1, 2, 73});
        ply.Put<uint8_t>({1}).Put<int>({9, 74});
        const MeshData mesh = Load(ply.text);
        EXPECT_EQ(mesh.triangles,
                  (std::vector<Triangle>{
                      {0, 1, 2}, {0, 2, 3}, {0, 1, 2}, {0, 2, 3}, {0, 3, 4}, {4, 1, 2}}));
        EXPECT_EQ(mesh.faceIndices, (std::vector{70, 70, 71, 71, 71, 73}));
    }
    EXPECT_EQ(warnings.Counts().at("face left out that has not 3 to 256 vertices"), 6);
}

// Also where they are not convex: with the area that they have, and no corner lost.
TEST_F(Ply, ConcavePolygonsAreDividedWithin) {
    const auto areaOf = [&](const std::vector<Vec3f>& corners) {
        PlyWriter ply("ascii");
        ply.Header(Header(fmt::format("{}", corners.size()), "1"));
        for (const Vec3f& p : corners) ply.Put<float>({p.x(), p.y(), p.z()});
        ply.text += fmt::format("{}", corners.size());
        for (size_t i = 0; i < corners.size(); ++i) ply.text += fmt::format(" {}", i);
        const MeshData mesh = Load(ply.text);
        EXPECT_EQ(mesh.triangles.size(), corners.size() - 2);
        double area = 0;
        for (const Triangle& t : mesh.triangles) {
            const Vec3f &a = corners[t[0]], &b = corners[t[1]], &c = corners[t[2]];
            area += double((b - a).cross(c - a).norm()) / 2;
        }
        return area;
    };
    // An arrow head, begun at each of its corners, and an L, upright in space.
    const std::vector<Vec3f> arrow = {{0, 0, 0}, {2, 1, 0}, {0, 2, 0}, {0.5f, 1, 0}};
    for (size_t first = 0; first < 4; ++first) {
        std::vector<Vec3f> turned = arrow;
        std::ranges::rotate(turned, turned.begin() + long(first));
        EXPECT_NEAR(areaOf(turned), 1.5, 1e-6) << first;
        std::ranges::reverse(turned);
        EXPECT_NEAR(areaOf(turned), 1.5, 1e-6) << first;
    }
    EXPECT_NEAR(areaOf({{0, 0, 1}, {0, 3, 1}, {0, 3, 2}, {0, 1, 2}, {0, 1, 4}, {0, 0, 4}}), 5,
                1e-6);
}

// Their first triangle tells the front, -1 begins another; faces may come before and after.
TEST_F(Ply, TriangleStrips) {
    for (const std::string format : kFormats)
        for (const bool isFirst : {false, true}) {
            const std::string strips =
                                  "element tristrips 2\nproperty list int int vertex_indices\n",
                              face = "element face 1\n" + kFaces +
                                     "property list uchar float texcoord\nproperty int "
                                     "face_indices\n";
            PlyWriter ply(format);
            ply.Header("element vertex 4\n" + kPositions +
                       (isFirst ? strips + face : face + strips));
            for (int i = 0; i < 4; ++i) ply.Put<float>({double(i), 0, 0});
            const auto putFace = [&] {
                ply.Put<uint8_t>({3}).Put<int>({3, 2, 1}).Put<uint8_t>({0}).Put<int>({7});
            };
            if (!isFirst) putFace();
            ply.Put<int>({4, 0, 1, 3, 2}).Put<int>({9, 0, 1, 2, -1, 0, 2, 2, 3, 1});
            if (isFirst) putFace();
            const MeshData mesh = Load(ply.text);
            std::vector<Triangle> expected = {{0, 1, 3}, {3, 1, 2}, {0, 1, 2}, {2, 3, 1}};
            expected.insert(isFirst ? expected.end() : expected.begin(), {3, 2, 1});
            EXPECT_EQ(mesh.triangles, expected) << format;
            EXPECT_EQ(mesh.faceIndices.size(), 5u);
        }
    EXPECT_EQ(ErrorOf("ply\nformat ascii 1.0\nelement vertex 1\n" + kPositions +
                      "element tristrips 1\nproperty list int int vertex_indices\nend_header\n"
                      "0 0 0\n3 0 0 -2\n"),
              "a.ply:11: a face has the vertex index -2.000000");
}

// Unsigned numbers have no -1.
TEST_F(Ply, TheLargestNumberBeginsAStripInUnsignedLists) {
    PlyWriter ply("binary_little_endian");
    ply.Header("element vertex 3\n" + kPositions +
               "element tristrips 1\nproperty list uchar ushort vertex_indices\n");
    for (int i = 0; i < 3; ++i) ply.Put<float>({double(i), 0, 0});
    ply.Put<uint8_t>({7}).Put<uint16_t>({0, 1, 2, 65535, 2, 1, 0});
    EXPECT_EQ(Load(ply.text).triangles, (std::vector<Triangle>{{0, 1, 2}, {2, 1, 0}}));
}

TEST_F(Ply, AnEmptyMeshIsLeftOut) {
    EXPECT_TRUE(Load("ply\nformat ascii 1.0\n" + Header("1", "1") + "end_header\n0 0 0\n0\n")
                    .triangles.empty());
    EXPECT_EQ(warnings.Counts().at("a PLY file without triangles is left out"), 1);
}

TEST_F(Ply, UnusedVerticesNeedNotBeFinite) {
    const MeshData mesh = Load("ply\nformat ascii 1.0\n" + Header("4", "1") +
                               "end_header\n1 2 3\nnan 0 inf\n1 0 0\n0 1 0\n3 0 2 3\n");
    EXPECT_EQ(mesh.positions[1], Vec3f(1, 2, 3));
    EXPECT_EQ(warnings.Counts().at("unused vertex of a PLY file that is not finite"), 1);
}

// Marks that old programs end texts by, and colours.
TEST_F(Ply, WarnsOfWhatIsLeftOut) {
    const std::string vertices = "0 0 0 9\n1 0 0 9\n0 1 0 9\n";
    PlyWriter ply("ascii");
    ply.Header(Header("3", "1", "property uchar red\n"));
    for (const char* end : {"", "\n", "\x1a", "\n\x1a", "\n\x1a garbage"})
        Load(ply.text + vertices + "3 0 1 2" + end);
    EXPECT_EQ(warnings.Counts().size(), 1u);
    EXPECT_EQ(warnings.Counts().at("colours of a PLY file are left out; glTF files can have them"),
              5);
}

TEST_F(Ply, WarnsOfPropertiesGivenTwice) {
    const MeshData mesh = Load("ply\nformat ascii 1.0\n" + Header("3", "1", "property float x\n") +
                               "element other 1\nproperty int a\nproperty int a\nend_header\n"
                               "0 0 0 9\n1 0 0 9\n0 1 0 9\n3 0 1 2\n1 2\n");
    EXPECT_EQ(mesh.positions[1], Vec3f(1, 0, 0));
    EXPECT_EQ(warnings.Total(), 1);
    EXPECT_EQ(warnings.Counts().at("PLY property given twice, of which one counts"), 1);
}

TEST_F(Ply, PropertiesInAnyOrderAndType) {
    for (const std::string format : kFormats) {
        PlyWriter ply(format);
        ply.Header(
            "element vertex 3\nproperty uchar red\nproperty double ny\nproperty short z\n"
            "property float nx\nproperty int8 x\nproperty uint16 nz\nproperty int t\n"
            "property uint y\nproperty uchar s\n"
            "element face 1\nproperty float quality\nproperty list uint16 uint8 vertex_index\n"
            "property list uchar float texcoord\n");
        for (int i = 0; i < 3; ++i)
            ply.Put<uint8_t>({200})
                .Put<double>({.25})
                .Put<int16_t>({-300})
                .Put<float>({-.5})
                .Put<int8_t>({-7})
                .Put<uint16_t>({60000})
                .Put<int>({-100000})
                .Put<uint32_t>({70000. + i})
                .Put<uint8_t>({9});
        ply.Put<float>({.5}).Put<uint16_t>({3}).Put<uint8_t>({2, 1, 0});
        ply.Put<uint8_t>({2}).Put<float>({.1, .2});
        const MeshData mesh = Load(ply.text);
        ASSERT_EQ(mesh.positions.size(), 3u) << format;
        EXPECT_EQ(mesh.positions[1], Vec3f(-7, 70001, -300));
        EXPECT_EQ(mesh.normals.at(2), Vec3f(-.5f, .25f, 60000));
        EXPECT_EQ(mesh.uvs.at(0), Vec2f(9, -100000));
        EXPECT_EQ(mesh.triangles, (std::vector<Triangle>{{2, 1, 0}}));
    }
}

// In any order and case.
TEST_F(Ply, EveryNameOfTextureCoordinates) {
    for (const auto& [u, v] : {std::pair("u", "v"),
                               {"s", "t"},
                               {"texture_u", "texture_v"},
                               {"texture_s", "texture_t"},
                               {"tex_s", "tex_t"},
                               {"texcoord_u", "texcoord_v"},
                               {"texcoord_x", "texcoord_y"},
                               {"TexCoordU", "TexCoordV"},
                               {"TEXTURE_U", "TEXTURE_V"},
                               {"U", "V"},
                               {"u0", "v0"},
                               {"u1", "v1"}}) {
        PlyWriter ply("ascii");
        ply.Header(Header("3", "1", fmt::format("property float {}\nproperty float {}\n", v, u)));
        for (int i = 0; i < 3; ++i) ply.Put<float>({0, 0, 0, .75, .25});
        ply.Put<int>({3, 0, 1, 2});
        EXPECT_EQ(Load(ply.text).uvs.at(2), Vec2f(.25f, .75f)) << u;
    }
    EXPECT_EQ(warnings.Total(), 0);
}

TEST_F(Ply, OtherTextureCoordinatesAndColoursAreLeftOutWithAWarning) {
    for (const std::string property : {"list uchar float uv", "float tex0"}) {
        PlyWriter ply("ascii");
        ply.Header(Header("3", "1", "property " + property + "\nproperty uchar r\n"));
        const std::string rest = property.starts_with("list") ? " 1 .5 9\n" : " .5 9\n";
        Load(ply.text + "0 0 0" + rest + "1 0 0" + rest + "0 1 0" + rest + "3 0 1 2\n");
    }
    EXPECT_EQ(warnings.Total(), 4);
}

TEST_F(Ply, IncompleteNormalsAndUvsAreIgnored) {
    PlyWriter ply("ascii");
    ply.Header(Header("3", "1", "property float nx\nproperty float ny\nproperty float u\n"));
    for (int i = 0; i < 3; ++i) ply.Put<float>({0, 0, 0, 1, 1, 1});
    ply.Put<int>({3, 0, 1, 2});
    const MeshData mesh = Load(ply.text);
    EXPECT_TRUE(mesh.normals.empty() && mesh.uvs.empty());
}

TEST_F(Ply, UnknownElementsAreSkippedAndFacesMayComeFirst) {
    for (const std::string format : kFormats) {
        PlyWriter ply(format);
        ply.Header(
            "element camera 2\nproperty double fov\nproperty uchar kind\nelement empty 9\n"
            "element strips 2\nproperty list uchar int indices\nelement face 1\n" +
            kFaces + "element vertex 3\n" + kPositions);
        for (int i = 0; i < 2; ++i) ply.Put<double>({.5}).Put<uint8_t>({1});
        ply.Put<uint8_t>({0}).Put<uint8_t>({2}).Put<int>({1, 2});
        ply.Put<uint8_t>({3}).Put<int>({0, 1, 2});
        for (int i = 0; i < 3; ++i) ply.Put<float>({1. * i, 0, 0});
        const MeshData mesh = Load(ply.text);
        EXPECT_EQ(mesh.positions.at(2).x(), 2) << format;
        EXPECT_EQ(mesh.triangles.size(), 1u);
    }
}

TEST_F(Ply, CarriageReturnsAndBlankLines) {
    const MeshData mesh = Load(
        "ply\r\nformat ascii 1.0\r\n\r\nelement vertex 3\r\n"
        "property float x\r\nproperty float y\r\nproperty float z\r\n"
        "element face 1\r\nproperty list uchar int vertex_indices\r\n"
        "end_header\r\n0 0 0\r\n+1 0 0\r\n\r\n0 1e0 0\r\n3 0 1 2");
    EXPECT_EQ(mesh.positions[2], Vec3f(0, 1, 0));
}

TEST_F(Ply, JoinedGzipMembersAreOneFile) {
    PlyWriter ply("ascii");
    ply.Header(Header("3", "1")).Put<float>({0, 0, 0, 1, 0, 0, 0, 1, 0}).Put<int>({3, 0, 1, 2});
    const size_t half = ply.text.size() / 2;
    EXPECT_EQ(Load(Gzip(ply.text.substr(0, half)) + Gzip(ply.text.substr(half))).positions.size(),
              3u);
}

TEST_F(Ply, NormalsThatAreNotFiniteBecomeZero) {
    PlyWriter ply("binary_little_endian");
    ply.Header(Header("3", "1", kNormals + "property float u\nproperty float v\n"));
    for (int i = 0; i < 3; ++i) ply.Put<float>({0, 0, 0, 1, 0, i == 1 ? NAN : 0, INFINITY, 0});
    ply.Put<uint8_t>({3}).Put<int>({0, 1, 2});
    const MeshData mesh = Load(ply.text);
    EXPECT_EQ(mesh.normals[0], Vec3f(1, 0, 0));
    EXPECT_EQ(mesh.normals[1], Vec3f::Zero());
    EXPECT_EQ(mesh.uvs[2], Vec2f::Zero());
    EXPECT_EQ(warnings.Counts().at("normal in a PLY file that is not finite"), 1);
    EXPECT_EQ(warnings.Counts().at("uv in a PLY file that is not finite"), 3);
}

TEST_F(Ply, BadHeaders) {
    const auto expect = [&](const std::string& lines, const std::string& message) {
        EXPECT_EQ(ErrorOf("ply\n" + lines + "end_header\n"), message);
    };
    for (const std::string& text : {std::string(), std::string("PNG\n"), std::string(100000, 'x')})
        EXPECT_EQ(ErrorOf(text), "a.ply:1: not a PLY file: its first line must be 'ply'");
    EXPECT_EQ(ErrorOf("ply\nformat ascii 1.0\n"), "a.ply:3: the PLY header has no end_header");
    expect("", "a.ply:2: the PLY header names no format");
    expect("format text 1.0\n", "a.ply:2: unknown PLY format 'text'");
    for (const std::string line : {"colour red", "element vertex"})
        expect(line + "\n", "a.ply:2: '" + line + "' does not belong in a PLY header");
    for (const std::string count : {"-3", "3x", "99999999999999999999"})
        expect("element vertex " + count + "\n",
               "a.ply:2: '" + count + "' cannot be the count of PLY element 'vertex'");
    expect("property float x\n", "a.ply:2: a PLY property must come after an element");
    expect("element vertex 1\nproperty half x\n", "a.ply:3: unknown type 'half' in a PLY header");
    expect("element vertex 1\nproperty float\n",
           "a.ply:3: a PLY property is written 'property TYPE NAME' or 'property list TYPE TYPE "
           "NAME'");
    expect("element face 1\nproperty list float int vertex_indices\n",
           "a.ply:3: the counts of a PLY list must be of an integer type");
}

TEST_F(Ply, MissingParts) {
    const std::string ascii = "ply\nformat ascii 1.0\n";
    EXPECT_EQ(ErrorOf(ascii + "end_header\n"), "a.ply: the PLY file has no faces");
    EXPECT_EQ(ErrorOf(ascii + Header("0", "0") + "end_header\n"), "");
    EXPECT_EQ(ErrorOf(ascii + "element vertex 1\nproperty float x\nend_header\n0"),
              "a.ply: the vertices of the PLY file have no x, y and z");
    EXPECT_EQ(ErrorOf(ascii + "element face 1\nproperty float x\nend_header\n0"),
              "a.ply: the faces of the PLY file need one list vertex_indices");
    EXPECT_EQ(ErrorOf(ascii + Header("0", "0") + Header("0", "0") + "end_header\n"),
              "a.ply: the PLY file has two elements 'vertex'");
}

TEST_F(Ply, TruncatedFilesAndAbsurdCounts) {
    for (const std::string format : kFormats) {
        PlyWriter ply(format);
        ply.Header(Header("3", "1"));
        const size_t header = ply.text.size();
        ply.Put<float>({0, 0, 0, 1, 0, 0, 0, 1, 0}).Put<uint8_t>({3}).Put<int>({0, 1, 2});
        // An ASCII file may lack its last blanks and zeros.
        const size_t whole = format == "ascii" ? ply.text.find("2.0") + 1 : ply.text.size();
        for (size_t size = header; size < whole; ++size)
            EXPECT_HAS(ErrorOf(ply.text.substr(0, size)), "the PLY file ends before") << format;
        for (const std::string count : {"1000000000", "4000000000", "9000000000000000000"}) {
            EXPECT_EQ(ErrorOf(PlyWriter(format).Header(Header(count, "1")).text + "0 0 0 "),
                      "a.ply: the PLY file ends before the " + count + " rows of element 'vertex'");
            EXPECT_EQ(ErrorOf(PlyWriter(format).Header("element x " + count + "\n" + kFaces).text),
                      "a.ply: the PLY file ends before the " + count + " rows of element 'x'");
        }
    }
    const std::string packed = Gzip(std::string(10000, 'a'));
    for (const std::string& text :
         {packed.substr(0, packed.size() / 2), std::string("\x1f\x8bxxxxxxxxxxxxxxxxx")})
        EXPECT_EQ(ErrorOf(text), "a.ply: the gzip'd data are damaged or cut short");
    EXPECT_EQ(ErrorOf(Gzip(std::string(size_t(65) << 20, '\0'))),
              "a.ply: unpacks to more than 67108864 bytes; unpack it by hand if it is right");
}

TEST_F(Ply, BadValues) {
    const auto errorOf = [&](const std::string& vertex, const std::string& face) {
        return ErrorOf("ply\nformat ascii 1.0\n" + Header("3", "1") + "end_header\n0 0 0\n1 0 0\n" +
                       vertex + "\n" + face + "\n");
    };
    for (const char* vertex : {"0 nan 0", "0 inf 0", "0 1e39 0"})
        EXPECT_EQ(errorOf(vertex, "3 0 1 2"), "a.ply: vertex 2 of the PLY file is not finite");
    EXPECT_EQ(errorOf("0 1e999 0", "3 0 1 2"),
              "a.ply:12: '1e999' is not a number that can be used");
    EXPECT_EQ(errorOf("0 x 0", "3 0 1 2"), "a.ply:12: 'x' is not a number that can be used");
    EXPECT_EQ(errorOf("0 1 0", "3 0 1 3"), "a.ply: triangle 0 refers to vertex 3, but there are 3");
    EXPECT_EQ(errorOf("0 1 0", "3 0 1 -1"), "a.ply:13: a face has the vertex index -1.000000");
    EXPECT_EQ(errorOf("0 1 0", "3 0 1 .5"), "a.ply:13: a face has the vertex index 0.500000");
    for (const char* face : {"3 0 .9999999 -1e-9", "0", "2 0 1"})
        EXPECT_EQ(errorOf("0 1 0", face), "") << face;
    EXPECT_EQ(errorOf("0 1 0", "-3 0 1 2"),
              "a.ply:13: a list of property 'vertex_indices' has a "
              "count that is negative or no integer");
    // The bulk path of binary files finds them as well.
    PlyWriter ply("binary_little_endian");
    ply.Header(Header("1", "1")).Put<float>({0, 0, 0}).Put<uint8_t>({3}).Put<int>({0, 0, -1});
    EXPECT_EQ(ErrorOf(ply.text), "a.ply: triangle 0 refers to vertex 4294967295, but there are 1");
}

TEST_F(Ply, FilesThatCannotBeRead) {
    const FileLoc loc{std::make_shared<const std::string>("scene.pbrt"), 7};
    EXPECT_EQ(folder.MessageOf([&] { LoadPly(folder.File("none.ply"), warnings, loc); }),
              "scene.pbrt:7: cannot read 'none.ply': No such file or directory");
}

// The square 0123, of which corner 0 has other uvs in the second triangle, as MeshLab writes it.
TEST_F(Ply, VerticesAreSplitByTheUvsOfFaces) {
    for (const std::string format : kFormats)
        for (const char* name : {"texcoord", "t"}) {
            PlyWriter ply(format);
            ply.Header(Header("4", "2", kNormals) + "property list uchar float " + name + "\n");
            for (int i = 0; i < 4; ++i) ply.Put<float>({double(i), 0, 0, 0, 0, double(i)});
            ply.Put<uint8_t>({3}).Put<int>({0, 1, 2});
            ply.Put<uint8_t>({6}).Put<float>({0, 0, 1, 0, 1, 1});
            ply.Put<uint8_t>({3}).Put<int>({0, 2, 3});
            ply.Put<uint8_t>({6}).Put<float>({.5, .5, 1, 1, 0, 1});
            const MeshData mesh = Load(ply.text);
            EXPECT_EQ(mesh.triangles, (std::vector<Triangle>{{0, 1, 2}, {3, 2, 4}})) << format;
            ASSERT_EQ(mesh.uvs.size(), 5u);
            EXPECT_EQ(mesh.uvs[2], Vec2f(1, 1));
            EXPECT_EQ(mesh.uvs[3], Vec2f(.5f, .5f));
            EXPECT_EQ(mesh.positions[3], Vec3f(0, 0, 0));
            EXPECT_EQ(mesh.positions[4], Vec3f(3, 0, 0));
            EXPECT_EQ(mesh.normals[4], Vec3f(0, 0, 3));
        }
    EXPECT_EQ(warnings.Total(), 0);
}

TEST_F(Ply, QuadsHaveUvsAndFacesWithoutKeepThoseOfVertices) {
    PlyWriter ply("ascii");
    ply.Header("element vertex 4\n" + kPositions +
               "property float s\nproperty float t\nelement face 2\n" +
               "property list uchar float texcoord\n" + kFaces);
    for (int i = 0; i < 4; ++i) ply.Put<float>({double(i), 0, 0, 7, double(i)});
    ply.Put<int>({8}).Put<float>({0, 0, 1, 0, 1, 1, 0, 1}).Put<int>({4, 0, 1, 2, 3});
    ply.Put<int>({0}).Put<int>({3, 0, 1, 2});
    const MeshData mesh = Load(ply.text);
    ASSERT_EQ(mesh.triangles.size(), 3u);
    EXPECT_EQ(mesh.uvs[mesh.triangles[1][2]], Vec2f(0, 1));
    EXPECT_EQ(mesh.uvs[mesh.triangles[2][1]], Vec2f(7, 1));
    EXPECT_EQ(mesh.positions.size(), 7u);
    EXPECT_EQ(warnings.Total(), 0);
}

TEST_F(Ply, LinesMayEndInCarriageReturnsAlone) {
    std::string binary =
        "ply\rformat binary_little_endian 1.0\relement vertex 3\rproperty uchar x\r"
        "property uchar y\rproperty uchar z\relement face 1\r"
        "property list uchar int vertex_indices\rend_header\r";
    // Data begins at once, with what would be the other half of a line's end.
    binary += std::string("\n\1\2\3\4\5\6\7\10\3\0\0\0\0\1\0\0\0\2\0\0\0", 22);
    EXPECT_EQ(Load(binary).positions[0], Vec3f(10, 1, 2));
    EXPECT_EQ(Load(binary).positions[2], Vec3f(6, 7, 8));
    std::string ascii =
        "ply\rformat ascii 1.0\relement vertex 3\rproperty float x\rproperty float y\r"
        "property float z\relement face 1\rproperty list uchar int vertex_indices\rend_header\r"
        "0 0 0\r1 0 0\r0 1 0\r3 0 1 2\r";
    EXPECT_EQ(Load(ascii).positions[1], Vec3f(1, 0, 0));
    EXPECT_EQ(Load("\xef\xbb\xbf" + ascii).positions[1], Vec3f(1, 0, 0));
    ascii[ascii.find("1 0 0")] = 'x';
    EXPECT_EQ(ErrorOf(ascii), "a.ply:11: 'x' is not a number that can be used");
}

}  // namespace
}  // namespace lull
