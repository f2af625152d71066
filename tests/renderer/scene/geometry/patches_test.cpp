#include "renderer/scene/geometry/shapes/shape_factory.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "tests/renderer/files/test_files.h"
#include "tests/renderer/scene/textures/texture_builder.h"

namespace lull {
namespace {

TEST(Heightfield, SpansTheUnitSquare) {
    const MeshData data = HeightfieldMesh(
        ShapeOf("heightfield", {Int("nu", 3), Int("nv", 2), Floats("Pz", {1, 2, 3, 4, 5, 6})}));
    ASSERT_EQ(data.positions.size(), 6u);
    EXPECT_EQ(data.positions[1], Vec3f(0.5f, 0, 2));
    EXPECT_EQ(data.positions[5], Vec3f(1, 1, 6));
    EXPECT_EQ(data.uvs[4], Vec2f(0.5f, 1));
    ASSERT_EQ(data.triangles.size(), 4u);
    EXPECT_EQ(data.triangles[2], (std::array<uint32_t, 3>{1, 2, 5}));
    EXPECT_EQ(data.triangles[3], (std::array<uint32_t, 3>{1, 5, 4}));
}

TEST(Heightfield, RefusesNonsense) {
    const auto error = [](std::vector<Parameter> parameters) {
        return ErrorOf([&] { HeightfieldMesh(ShapeOf("heightfield", parameters)); });
    };
    EXPECT_HAS(error({}), "scene.pbrt:3: \"nu\" of a heightfield");
    EXPECT_HAS(error({Int("nu", 2), Int("nv", 1)}), "\"nv\"");
    EXPECT_HAS(error({Int("nu", 2), Int("nv", 2), Floats("Pz", {1, 2, 3})}), "\"Pz\"");
    EXPECT_HAS(error({Int("nu", 2), Int("nv", 2), Floats("Pz", {1, 2, 3, std::nanf("")})}),
               "not finite");
}

std::vector<Parameter> Net(int n, int order, const std::vector<float>& knots) {
    std::vector<Parameter> parameters;
    for (const char* letter : {"u", "v"}) {
        parameters.push_back(Int(std::string("n") + letter, n));
        parameters.push_back(Int(std::string(letter) + "order", order));
        parameters.push_back(Floats(std::string(letter) + "knots", knots));
    }
    return parameters;
}

// A bicubic Bezier patch is its Bernstein form.
TEST(Nurbs, EqualsABezierPatch) {
    std::vector<Parameter> parameters = Net(4, 4, {0, 0, 0, 0, 1, 1, 1, 1});
    std::vector<float> points;
    for (int j = 0; j < 4; ++j)
        for (int i = 0; i < 4; ++i)
            for (const float x : {float(i), float(j), float((i * 7 + j * 5) % 6) / 3})
                points.push_back(x);
    parameters.push_back(PointParameter("P", points));
    const MeshData data = NurbsMesh(ShapeOf("nurbs", parameters));
    ASSERT_EQ(data.positions.size(), 900u);
    const auto bernstein = [](int i, double t) {
        const double choose[] = {1, 3, 3, 1};
        return choose[i] * std::pow(t, i) * std::pow(1 - t, 3 - i);
    };
    const auto surface = [&](double u, double v) {
        Eigen::Vector3d p = Eigen::Vector3d::Zero();
        for (int k = 0; k < 16; ++k)
            p += bernstein(k % 4, u) * bernstein(k / 4, v) *
                 Eigen::Vector3d(points[3 * k], points[3 * k + 1], points[3 * k + 2]);
        return p;
    };
    for (int k = 0; k < 900; ++k) {
        const double u = k % 30 / 29.0, v = k / 30 / 29.0, h = 1e-5;
        ASSERT_NEAR((data.positions[k].cast<double>() - surface(u, v)).norm(), 0, 1e-5) << k;
        ASSERT_NEAR(data.uvs[k].x(), u, 1e-6);
        const Eigen::Vector3d n = (surface(u + h, v) - surface(u - h, v))
                                      .cross(surface(u, v + h) - surface(u, v - h))
                                      .normalized();
        ASSERT_GT(data.normals[k].cast<double>().dot(n), 0.99999) << k;
    }
}

// A quarter of a circle is a rational quadratic: the weights make a cylinder of it.
TEST(Nurbs, WeightsMakeACylinder) {
    const float w = std::sqrt(0.5f);
    const MeshData data = NurbsMesh(
        ShapeOf("nurbs", {Int("nu", 3), Int("uorder", 3), Floats("uknots", {0, 0, 0, 2, 2, 2}),
                          Int("nv", 2), Int("vorder", 2), Floats("vknots", {0, 0, 1, 1}),
                          Float("v1", 0.5f), Floats("Pw", {1, 0, 0, 1, w, w, 0, w, 0, 1, 0, 1,  //
                                                           1, 0, 1, 1, w, w, w, w, 0, 1, 1, 1})}));
    for (size_t k = 0; k < data.positions.size(); ++k) {
        const Vec3f& p = data.positions[k];
        ASSERT_NEAR(p.head<2>().norm(), 1, 1e-5);
        ASSERT_LE(p.z(), 0.50001f);
        ASSERT_NEAR(std::abs(data.normals[k].dot(Vec3f(p.x(), p.y(), 0))), 1, 1e-5);
    }
}

TEST(Nurbs, RefusesNonsense) {
    const auto error = [](std::vector<Parameter> parameters, Parameter last) {
        parameters.push_back(std::move(last));
        return ErrorOf([&] { NurbsMesh(ShapeOf("nurbs", parameters)); });
    };
    const std::vector<float> knots = {0, 0, 1, 1}, points(12, 1.f);
    const Parameter good = PointParameter("P", points);
    EXPECT_EQ(error(Net(2, 2, knots), good), "");
    EXPECT_HAS(error({}, good), "scene.pbrt:3: \"nu\"");
    EXPECT_HAS(error(Net(2, 1, knots), good), "\"uorder\"");
    EXPECT_HAS(error(Net(2, 3, knots), good), "\"uorder\" is 3");
    EXPECT_HAS(error(Net(2, 2, {0, 1}), good), "\"uknots\" has 2 values");
    EXPECT_HAS(error(Net(2, 2, {0, 1, 0, 1}), good), "ascending");
    EXPECT_HAS(error(Net(2, 2, {1, 1, 1, 1}), good), "no range");
    EXPECT_HAS(error(Net(2, 2, knots), PointParameter("P", {1, 2, 3})), "control points");
    std::vector<Parameter> outside = Net(2, 2, knots);
    outside.push_back(Float("u1", 2));
    EXPECT_HAS(error(outside, good), "\"u1\"");
}

}  // namespace
}  // namespace lull
