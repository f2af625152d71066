#include "renderer/scene/geometry/reach.h"

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

}  // namespace lull
