#include "renderer/input/gltf/framing.h"

#include <limits>
#include <numbers>

namespace lull {
namespace {

constexpr double kMargin = 0.06;  // of the picture, that stays free at each side
constexpr double kInfinite = std::numeric_limits<double>::infinity();

}  // namespace

std::vector<Vec3f> OutlineOf(const std::vector<float>& points) {
    constexpr int kDirections = 100;
    std::vector<Vec3f> outline;
    if (points.empty()) return outline;
    const Eigen::Map<const Eigen::Matrix3Xf> all(points.data(), 3, long(points.size() / 3));
    for (int i = 0; i < kDirections; ++i) {
        // A Fibonacci lattice on the sphere.
        const double z = 1 - (2 * i + 1.) / kDirections, r = std::sqrt(1 - z * z);
        const double phi = 2 * std::numbers::pi * i / std::numbers::phi;
        const Vec3f d(float(r * std::cos(phi)), float(r * std::sin(phi)), float(z));
        long farthest = 0;
        (d.transpose() * all).maxCoeff(&farthest);
        outline.push_back(all.col(farthest));
    }
    return outline;
}

Framing::Framing(double azimuth, double elevation, const std::array<double, 2>& seen)
    : tangents(seen), nearest(-kInfinite), farthest(kInfinite) {
    constexpr double kDegree = std::numbers::pi / 180;
    const double a = azimuth * kDegree, e = elevation * kDegree;
    axes.col(2) =
        Eigen::Vector3d(std::cos(e) * std::sin(a), std::sin(e), std::cos(e) * std::cos(a));
    axes.col(0) = Eigen::Vector3d(std::cos(a), 0, -std::sin(a));
    axes.col(1) = axes.col(2).cross(axes.col(0));
    for (double& tangent : tangents) tangent *= 1 - 2 * kMargin;
    for (auto& side : reach) side = {-kInfinite, -kInfinite};
}

void Framing::Extend(const Vec3f& point) {
    const Eigen::Vector3d p = axes.transpose() * point.cast<double>();
    for (int i = 0; i < 2; ++i)
        for (int side = 0; side < 2; ++side) {
            double& most = reach[size_t(i)][size_t(side)];
            most = std::max(most, (side == 0 ? -p[i] : p[i]) + tangents[size_t(i)] * p.z());
        }
    nearest = std::max(nearest, p.z());
    farthest = std::min(farthest, p.z());
}

Mat4d Framing::WorldFromCamera() const {
    if (!(nearest >= farthest)) {
        Framing ball = *this;
        for (int i = 0; i < 6; ++i) ball.Extend((i % 2 ? 1.f : -1.f) * Vec3f(Vec3f::Unit(i / 2)));
        return ball.WorldFromCamera();
    }
    Eigen::Vector3d at;
    double extent = nearest - farthest;
    at.z() = -kInfinite;
    for (int i = 0; i < 2; ++i) {
        const auto& [low, high] = reach[size_t(i)];
        at[i] = (high - low) / 2;
        const double wanted = (high + low) / (2 * tangents[size_t(i)]);
        at.z() = std::max(at.z(), wanted);
        extent = std::max(extent, wanted - nearest);
    }
    // Flat objects and points must not be at the camera.
    at.z() = std::max(at.z(), nearest + std::max(0.1 * extent, 1e-6));
    Mat4d m = Mat4d::Identity();
    m.topLeftCorner<3, 3>() = axes;
    m.col(3).head<3>() = axes * at;
    return m;
}

}  // namespace lull
