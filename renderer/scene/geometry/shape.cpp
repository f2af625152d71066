#include "renderer/scene/geometry/shape.h"

namespace lull {

double Farthest(const Bounds3f& box) {
    if (box.IsEmpty()) return 0;
    return box.lower.cwiseAbs().cwiseMax(box.upper.cwiseAbs()).cast<double>().norm();
}

double ReachThrough(const Mat4d& transform) {
    const double scale = transform.topLeftCorner<3, 3>().norm();
    const double offset = transform.topRightCorner<3, 1>().norm();
    // The origins of rays are within reach, and shadow rays twice as long.
    return std::min(double(kFarthest), (double(kLongestRay) - offset) / (4 * scale));
}

bool IsInvertibleInFloats(const Mat4d& transform) {
    const auto linear = transform.topLeftCorner<3, 3>();
    const Eigen::Array3d lengths = linear.colwise().norm();
    const double determinant = std::abs(linear.determinant()), product = lengths.prod();
    const double least = std::min(determinant, product / lengths.maxCoeff());
    const double greatest = std::max(determinant, product / lengths.minCoeff());
    return least >= double(std::numeric_limits<float>::min()) &&
           greatest <= double(std::numeric_limits<float>::max());
}

Emitter EmitterOf(const Geometry& geometry, uint32_t primitive) {
    return std::visit(
        [&]<typename S>(const S& shape) -> Emitter {
            if constexpr (std::is_same_v<S, Mesh>)
                return shape.EmitterAt(primitive);
            else if constexpr (std::is_constructible_v<Emitter, const S*>)
                return &shape;
            else
                throw Error("this kind of shape cannot emit light");
        },
        geometry);
}

uint32_t Shape::PrimitiveCount() const {
    return std::visit([](const auto& shape) { return shape.PrimitiveCount(); }, geometry);
}

Bounds3f Shape::WorldBounds() const {
    return std::visit([](const auto& shape) { return shape.WorldBounds(); }, geometry);
}

}  // namespace lull
