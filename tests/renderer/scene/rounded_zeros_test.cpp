// Numbers that have to be at least 0 are 0 where an exporter's rounding has left them just below.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "renderer/input/spectrum.h"
#include "renderer/scene/geometry/shapes/mesh.h"
#include "renderer/scene/scene.h"
#include "tests/renderer/files/test_files.h"
#include "tests/renderer/scene_of.h"

namespace lull::rounded_zeros_test {
namespace {

struct Place {
    const char *options, *world;  // with {} in place of the number
};

constexpr const char* kMedium =
    "MakeNamedMedium \"m\" \"string type\" \"{}\" {}\nMediumInterface \"m\" \"\"\n"
    "Shape \"sphere\"\n";

std::string Homogeneous(const std::string& parameters) {
    return fmt::format(fmt::runtime(kMedium), "homogeneous", parameters);
}

std::string ErrorWith(const Place& place, const char* number) {
    const auto filled = [&](const char* text) { return fmt::format(fmt::runtime(text), number); };
    return ErrorOf([&] { SceneOf(WorldText(filled(place.world), filled(place.options))); });
}

TEST(RoundedZeros, AreZeroInScenes) {
    const std::string absorption = Homogeneous("\"rgb sigma_a\" [1 {0} 1]"),
                      scattering = Homogeneous("\"rgb sigma_s\" [1 {0} 1]"),
                      scale = Homogeneous("\"float scale\" [{0}]"),
                      density = fmt::format(fmt::runtime(kMedium), "heterogeneous",
                                            "\"integer nx\" [2] \"float density\" [1 {0}] "
                                            "\"rgb sigma_a\" [1 1 1] \"rgb sigma_s\" [1 1 1]");
    const Place places[] = {
        {"\nCamera \"perspective\" \"float lensradius\" [{}]", "Shape \"sphere\""},
        {"\nCamera \"perspective\" \"float clipstart\" [{}]", "Shape \"sphere\""},
        {"", "Shape \"disk\" \"float innerradius\" [{}]"},
        {"", "Shape \"curve\" \"point P\" [0 0 0 1 0 0 2 0 0 3 0 0] \"float width0\" [{}]"},
        {"", "Material \"subsurface\" \"float scale\" [{}]\nShape \"sphere\""},
        {"Integrator \"volpath\"", absorption.c_str()},
        {"Integrator \"volpath\"", scattering.c_str()},
        {"Integrator \"volpath\"", scale.c_str()},
        {"Integrator \"volpath\"", density.c_str()},
    };
    for (const Place& place : places) {
        EXPECT_EQ(ErrorWith(place, "-1e-9"), "") << place.options << place.world;
        EXPECT_EQ(ErrorWith(place, "-0"), "") << place.options << place.world;
        EXPECT_HAS(ErrorWith(place, "-0.1"), "test.pbrt:") << place.options << place.world;
    }
}

// Only 0 is cut out, and so is what rounding makes of it.
TEST(RoundedZeros, OfAlphaAreCutOut) {
    const auto isHit = [](const char* alpha) {
        const auto scene = SceneOf(WorldText(fmt::format(
            "Shape \"trianglemesh\" \"integer indices\" [0 1 2] \"point P\" [-1 -1 1 1 -1 1 0 2 1] "
            "\"float alpha\" {}",
            alpha)));
        return scene->shapes.shapes.at(0).alpha.has_value();
    };
    EXPECT_TRUE(isHit("0"));
    EXPECT_TRUE(isHit("-1e-8"));
    EXPECT_FALSE(isHit("0.5"));
    EXPECT_FALSE(isHit("-0.5"));
}

TEST(RoundedZeros, AreZeroAsParameters) {
    EXPECT_EQ(RaisedToZero(-1e-9f), 0);
    EXPECT_EQ(RaisedToZero(-0.1f), -0.1f);
    EXPECT_EQ(RaisedToZero(0.1f), 0.1f);
    Entity entity;
    EXPECT_EQ(GetNonnegative(entity, "width", 0.5f), 0.5f);
}

TEST(RoundedLimits, OfSubsurfaceScatteringAreTheirLimits) {
    for (const char* value : {"0.999999", "1", "4.00001"})
        EXPECT_EQ(
            ErrorWith({"", "Material \"subsurface\" \"float eta\" [{}]\nShape \"sphere\""}, value),
            "")
            << value;
    EXPECT_HAS(
        ErrorWith({"", "Material \"subsurface\" \"float eta\" [{}]\nShape \"sphere\""}, "0.99"),
        "has to lie between 1 and 4");
}

}  // namespace
}  // namespace lull::rounded_zeros_test

// Checks that panes with a thickness are told from other closed meshes.

namespace lull::slabs_test {
namespace {

// Adds a box, with vertices of its own for each side, as glTF has it.
void AddBox(const Vec3f& lower, const Vec3f& upper, const Mat3f& turn, bool isOpen, Mesh* mesh) {
    for (int axis = 0; axis < 3; ++axis)
        for (const bool isUpper : {false, true}) {
            if (isOpen && axis == 2 && isUpper) continue;
            const auto first = uint32_t(mesh->p.size());
            for (int i = 0; i < 4; ++i) {
                Vec3f p;
                p[axis] = isUpper ? upper[axis] : lower[axis];
                const int a = (axis + 1) % 3, b = (axis + 2) % 3;
                p[a] = i % 2 ? upper[a] : lower[a];
                p[b] = i / 2 ? upper[b] : lower[b];
                mesh->p.push_back(turn * p);
            }
            const auto add = [&](uint32_t i, uint32_t j, uint32_t k) {
                if (!isUpper) std::swap(j, k);
                mesh->triangles.push_back({first + i, first + j, first + k});
            };
            add(0, 1, 3);
            add(0, 3, 2);
        }
}

int SlabsIn(const Vec3f& size, bool isOpen = false) {
    Mesh mesh;
    const Mat3f turn = Eigen::AngleAxisf(0.7f, Vec3f(1, 2, 3).normalized()).toRotationMatrix();
    AddBox(Vec3f(1, 2, 3), Vec3f(1, 2, 3) + size, turn, isOpen, &mesh);
    return CountSlabs(mesh);
}

TEST(Slabs, AreFlatAndClosed) {
    EXPECT_EQ(SlabsIn({1, 1.5f, 0.006f}), 1);
    EXPECT_EQ(SlabsIn({0.02f, 1, 1}), 1);
    EXPECT_EQ(SlabsIn({1, 1, 0.2f}), 0);
    EXPECT_EQ(SlabsIn({1, 0.03f, 0.03f}), 0);  // a rod
    EXPECT_EQ(SlabsIn({1, 0.05f, 0.006f}), 0);
    EXPECT_EQ(SlabsIn({1, 1.5f, 0.006f}, true), 0);
    EXPECT_EQ(SlabsIn({1, 1, 0}), 0);
    EXPECT_EQ(CountSlabs(Mesh()), 0);
}

TEST(Slabs, AreCountedOneByOne) {
    Mesh mesh;
    for (int i = 0; i < 3; ++i)
        AddBox(Vec3f(0, 0, float(i)), Vec3f(1, 1, float(i) + 0.01f), Mat3f::Identity(), false,
               &mesh);
    AddBox(Vec3f(0, 0, 5), Vec3f(1, 1, 6), Mat3f::Identity(), false, &mesh);
    EXPECT_EQ(CountSlabs(mesh), 3);
}

}  // namespace
}  // namespace lull::slabs_test
