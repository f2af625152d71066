#include "renderer/scene/geometry/shapes/placement.h"

#include <fmt/format.h>

namespace lull {

bool Mirrors(const Mat4d& m) { return m.topLeftCorner<3, 3>().determinant() < 0; }

std::optional<float> TakeScale(Mat4d* m) {
    auto linear = m->topLeftCorner<3, 3>();
    const double scale = linear.col(0).norm();
    if (!(linear.transpose() * linear).isApprox(scale * scale * Eigen::Matrix3d::Identity(), 1e-4))
        return {};
    linear /= scale;
    return float(scale);
}

QuadricPlacement PlacementOf(const ShapeEntity& entity, float* scale) {
    Mat4d m = entity.worldFromObject;
    const std::optional<float> taken = TakeScale(&m);
    if (!taken && entity.areaLight)
        throw Error(entity.loc, fmt::format("a light of shape \"{}\" under a transform that "
                                            "stretches it is not supported; a mesh is",
                                            entity.name));
    *scale = taken.value_or(1);
    return {m, m.inverse(), entity.reverseOrientation, entity.reverseOrientation != Mirrors(m)};
}

}  // namespace lull
