// Checks that panes with a thickness are told from other closed meshes.
#include "renderer/scene/scene.h"

#include <gtest/gtest.h>

#include "renderer/scene/geometry/shapes/mesh.h"

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
