#include "renderer/input/loop_subdivision.h"

#include <set>

#include "tests/renderer/input/test_files.h"
#include "tests/shared_folder.h"

namespace lull::loop_subdivision_test {
namespace {

using Floats = std::vector<float>;
using Ints = std::vector<int>;

const Floats kOctahedron = {1, 0, 0, -1, 0, 0, 0, 1, 0, 0, -1, 0, 0, 0, 1, 0, 0, -1};
const Ints kOctahedronFaces = {0, 2, 4, 2, 1, 4, 1, 3, 4, 3, 0, 4,
                               2, 0, 5, 1, 2, 5, 3, 1, 5, 0, 3, 5};

TEST(LoopSubdivision, CountsQuadruple) {
    for (int levels = -1; levels <= 4; ++levels) {
        const MeshData mesh = LoopSubdivide(kOctahedron, kOctahedronFaces, levels, {});
        const size_t faces = size_t(8) << (2 * std::max(levels, 0));
        EXPECT_EQ(mesh.triangles.size(), faces);
        EXPECT_EQ(mesh.positions.size(), faces / 2 + 2);  // Euler
        EXPECT_EQ(mesh.normals.size(), mesh.positions.size());
    }
}

TEST(LoopSubdivision, LimitOfAVertexIsTheSameFromEveryLevel) {
    const auto coarse = LoopSubdivide(kOctahedron, kOctahedronFaces, 0, {});
    const auto fine = LoopSubdivide(kOctahedron, kOctahedronFaces, 4, {});
    for (int v = 0; v < 6; ++v) {
        EXPECT_LT((coarse.positions[v] - fine.positions[v]).norm(), 1e-6f);
        // At valence 4 a neighbour weighs 1 / (4 + 3 / (8 beta)) = 1/8: half of the vertex stays,
        // and its ring cancels out.
        EXPECT_NEAR(fine.positions[v].norm(), .5f, 1e-6f);
    }
}

TEST(LoopSubdivision, NormalsPointAgainstCounterclockwiseFaces) {
    const auto mesh = LoopSubdivide(kOctahedron, kOctahedronFaces, 3, {});
    for (size_t v = 0; v < mesh.positions.size(); ++v)
        EXPECT_LT(mesh.normals[v].normalized().dot(mesh.positions[v].normalized()), -.95f);
}

TEST(LoopSubdivision, ValenceThreeUsesItsOwnWeight) {
    // A tetrahedron: beta(3) = 3/16, so a neighbour weighs 1 / (3 + 2) = 1/5 in the limit.
    const Floats p = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1};
    const auto mesh = LoopSubdivide(p, Ints{0, 1, 2, 0, 3, 1, 0, 2, 3, 1, 3, 2}, 0, {});
    EXPECT_LT((mesh.positions[0] - Vec3f(.2f, .2f, .2f)).norm(), 1e-6f);
    EXPECT_LT((mesh.positions[1] - Vec3f(.4f, .2f, .2f)).norm(), 1e-6f);
}

TEST(LoopSubdivision, BoundariesFollowTheirOwnCurve) {
    // A triangle: a corner is weighed 3/5, its neighbours 1/5 each.
    const Floats p = {0, 0, 0, 1, 0, 0, 0, 1, 0};
    const auto mesh = LoopSubdivide(p, Ints{0, 1, 2}, 0, {});
    EXPECT_LT((mesh.positions[1] - Vec3f(.6f, .2f, 0)).norm(), 1e-6f);
    const auto fine = LoopSubdivide(p, Ints{0, 1, 2}, 2, {});
    EXPECT_EQ(fine.triangles.size(), 16u);
    EXPECT_EQ(fine.positions.size(), 15u);
    for (const Vec3f& n : fine.normals) EXPECT_LT(n.normalized().z(), -.999f);
}

// Tests against the limit that pbrt-v3's own subdivision gives for a fan of six triangles with a
// vertex of boundary valence 7 in its middle.
TEST(LoopSubdivision, BoundaryFanMatchesPbrt) {
    Floats p = {0, 0, 0};
    Ints faces;
    for (int i = 0; i < 7; ++i) {
        p.insert(p.end(), {std::cos(i * .5f), std::sin(i * .5f), .1f * i});
        if (i > 0) faces.insert(faces.end(), {0, i, i + 1});
    }
    const auto mesh = LoopSubdivide(p, faces, 0, {});
    const Vec3f expected[][2] = {
        {{.00200159848f, .0282240007f, .120000005f}, {-.269713253f, .111372627f, -.965166271f}},
        {{.775516629f, .0958852023f, .0200000014f}, {-.0828387216f, .135581136f, -.549034119f}},
        {{.834610224f, .455949843f, .100000009f}, {-.0910782889f, .144636139f, -.698397875f}}};
    for (int v = 0; v < 3; ++v) {
        EXPECT_LT((mesh.positions[v] - expected[v][0]).norm(), 1e-5f);
        EXPECT_LT((mesh.normals[v] - expected[v][1]).norm(), 1e-5f);
    }
}

TEST(LoopSubdivision, UnusedVerticesStay) {
    const Floats p = {0, 0, 0, 1, 0, 0, 0, 1, 0, 9, 9, 9};
    const auto mesh = LoopSubdivide(p, Ints{0, 1, 2}, 1, {});
    EXPECT_EQ(mesh.positions[3], Vec3f(9, 9, 9));
    EXPECT_EQ(mesh.normals[3], Vec3f::Zero());
}

// Two closed fans that meet in one vertex: the walk around it stays in one of them.
TEST(LoopSubdivision, FansThatShareAVertexEnd) {
    Floats p = kOctahedron;
    p.insert(p.end(), {3, 0, 0, 2, 1, 0, 2, -1, 0, 2, 0, 1, 2, 0, -1});
    Ints faces = kOctahedronFaces;
    const int copy[] = {6, 0, 7, 8, 9, 10};  // its -x is the first's +x
    for (const int v : kOctahedronFaces) faces.push_back(copy[v]);
    EXPECT_EQ(LoopSubdivide(p, faces, 2, {}).triangles.size(), 256u);
}

TEST(LoopSubdivision, Errors) {
    const FileLoc loc{std::make_shared<const std::string>("a.pbrt"), 3};
    const TestFolder folder;
    const auto errorOf = [&](const Floats& p, const Ints& faces, int levels = 1) {
        return folder.MessageOf([&] { LoopSubdivide(p, faces, levels, loc); });
    };
    const Floats p = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 1, 1, 1};
    const auto expect = [&](const Ints& faces, const std::string& message, int levels = 1) {
        EXPECT_EQ(errorOf(p, faces, levels), "a.pbrt:3: loopsubdiv" + message);
    };
    expect({}, " needs vertex positions and indices, both in threes, but has 15 and 0 numbers");
    EXPECT_NE(errorOf(p, {0, 1}), "");
    EXPECT_NE(errorOf({0, 1}, {0, 1, 2}), "");
    expect({0, 1, 5}, ": index 5 is out of range, there are 5 vertices");
    expect({0, 1, -1}, ": index -1 is out of range, there are 5 vertices");
    expect({0, 1, 1}, ": face 0 repeats vertex 1");
    expect({0, 1, 2, 0, 1, 3},
           ": the edge between vertices 0 and 1 runs the same way in both its faces");
    expect({0, 1, 2, 1, 0, 3, 0, 1, 4},
           ": the edge between vertices 0 and 1 belongs to more than two faces");
    expect({0, 1, 2}, ": 13 levels make more than 50 million triangles; take fewer", 13);
    EXPECT_NE(errorOf(p, {0, 1, 2}, 2147483647), "");
    EXPECT_NE(errorOf({3e38f, 0, 0, 3e38f, 0, 0, 3e38f, 1, 0}, {0, 1, 2}), "");
}

TEST(LoopSubdivision, KillerooHasItsCounts) {
    LULL_SHARED_FILE(scene, "pbrt-scenes/killeroo-simple/scene.pbrt");
    Warnings warnings;
    const Description d = ParsePbrt(scene.string(), warnings);
    for (const ShapeEntity& shape : d.shapes) {
        if (shape.name != "loopsubdiv") continue;
        const auto p = shape.parameters.GetFloats(ParameterType::Point3, "P");
        const auto faces = shape.parameters.GetInts("indices");
        const auto mesh = LoopSubdivide(p, faces, shape.parameters.GetInt("nlevels", 3), shape.loc);
        EXPECT_EQ(mesh.triangles.size(), 33264u);
        EXPECT_EQ(mesh.positions.size(), 16899u);
        // The first vertex as pbrt-v3 has it.
        EXPECT_LT((mesh.positions[0] - Vec3f(-35.7382507f, 25.8273354f, -137.134171f)).norm(),
                  1e-4f);
        std::set<uint32_t> used;
        for (const auto& t : mesh.triangles) used.insert(t.begin(), t.end());
        EXPECT_EQ(used.size(), mesh.positions.size());
    }
}

}  // namespace
}  // namespace lull::loop_subdivision_test
