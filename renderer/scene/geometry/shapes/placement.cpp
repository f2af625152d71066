#include "renderer/scene/geometry/shapes/placement.h"

#include <fmt/format.h>

#include <Eigen/SVD>

namespace lull {
namespace {

// Replaces the linear part by the nearest rotation, mirrored where it mirrors, and returns its mean
// scale. Nothing is returned where it stretches by more than matrices of three decimals do.
std::optional<float> TakeNearestScale(Mat4d* m) {
    constexpr double kMostStretch = 5e-3;
    const Eigen::JacobiSVD<Eigen::Matrix3d> svd(m->topLeftCorner<3, 3>(),
                                                Eigen::ComputeFullU | Eigen::ComputeFullV);
    const Eigen::Vector3d scales = svd.singularValues();  // the largest first
    if (!(scales[0] - scales[2] <= kMostStretch * scales[0])) return {};
    m->topLeftCorner<3, 3>() = svd.matrixU() * svd.matrixV().transpose();
    return float(scales.mean());
}

}  // namespace

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
    std::optional<float> taken = TakeScale(&m);
    if (!taken && entity.areaLight) taken = TakeNearestScale(&m);
    if (!taken && entity.areaLight)
        throw Error(entity.loc, fmt::format("a light of shape \"{}\" under a transform that "
                                            "stretches it is not supported; a mesh is",
                                            entity.name));
    *scale = taken.value_or(1);
    return {m, m.inverse(), entity.reverseOrientation, entity.reverseOrientation != Mirrors(m)};
}

}  // namespace lull
