#include "renderer/scene/cameras/lens_system.h"

#include <gtest/gtest.h>

namespace lull::lens_bundle_test {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

// A ball of glass with a stop before it, on the side of the scene.
const std::vector<LensInterface> kBall = {{0, 0.5, 1, 0.4}, {1, 2, 1.5, 0.9}, {-1, 3, 1, 0.9}};
constexpr double kRearZ = 3;

LensBundle Traced(const std::vector<Vector2d>& rear) {
    LensBundle rays;
    for (const Vector2d& r : rear) rays.Add({0.1, 0, 0}, {r.x(), r.y(), kRearZ});
    rays.TraceFromFilm(kBall);
    return rays;
}

// Refracts by Snell's law, in the plane that holds the axis.
TEST(LensBundle, Refracts) {
    const std::vector<LensInterface> surface = {{-1, 3, 1.5, 0.9}};
    LensBundle rays;
    rays.Add({0, 0, 0}, {0, 0.3, kRearZ});
    rays.Add({0.3, 0, 0}, {0.3, 0, kRearZ});
    rays.TraceFromFilm(surface);
    ASSERT_EQ(rays.count, 2u);
    for (size_t i = 0; i < 2; ++i) {
        const Vector3d before = i == 0 ? Vector3d(0, 0.3, kRearZ).normalized() : Vector3d(0, 0, 1);
        const Vector3d at(rays.ox[i], rays.oy[i], rays.oz[i]);
        const Vector3d after(rays.dx[i], rays.dy[i], rays.dz[i]);
        const Vector3d normal = at - Vector3d(0, 0, kRearZ + 1);
        EXPECT_NEAR(normal.norm(), 1, 1e-12);
        EXPECT_LT(normal.z(), 0);  // the half that is turned to the film
        EXPECT_NEAR(after.norm(), 1, 1e-12);
        EXPECT_NEAR((1.5 * before.cross(normal) - after.cross(normal)).norm(), 0, 1e-12);
        EXPECT_GT(after.z(), 0);
    }
}

// However many others there are, each goes its own way.
TEST(LensBundle, KeepsThoseThatGetThrough) {
    std::vector<Vector2d> rear, alone;
    for (size_t i = 0; i < LensBundle::kMost; ++i)
        rear.push_back({-1 + 2 * double(i % 8) / 7, -1 + 2 * double(i / 8) / 7});
    for (const Vector2d& r : rear)
        if (Traced({r}).count == 1) alone.push_back(r);
    ASSERT_GT(alone.size(), 3u);
    ASSERT_LT(alone.size(), rear.size() - 3);
    const LensBundle all = Traced(rear);
    EXPECT_EQ(std::vector(all.rear.begin(), all.rear.begin() + long(all.count)), alone);
    for (size_t i = 0; i < all.count; ++i) {
        // Up to the rounding of what a compiler fuses, of vectors of rays or of the one left over.
        EXPECT_NEAR(all.ox[i], Traced({alone[i]}).ox[0], 1e-12);
        EXPECT_LE(std::hypot(all.ox[i], all.oy[i]), 0.4);
    }
}

}  // namespace
}  // namespace lull::lens_bundle_test
