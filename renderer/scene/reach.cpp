#include "renderer/scene/reach.h"

namespace lull {

double Farthest(const Bounds3f& box) {
    if (box.IsEmpty()) return 0;
    return box.lower.cwiseAbs().cwiseMax(box.upper.cwiseAbs()).cast<double>().norm();
}

double LongestRayInto(const Mat4d& transform) {
    const double scale = transform.topLeftCorner<3, 3>().norm();
    const double offset = transform.topRightCorner<3, 1>().norm();
    return std::min(double(kLongestRay), (double(kLongestRay) - offset) / scale);
}

}  // namespace lull
