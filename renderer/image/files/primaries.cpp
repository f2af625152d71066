#include "renderer/image/files/primaries.h"

#include <Eigen/LU>

namespace lull {

namespace {

const Primaries kRec709 = {{0.64f, 0.33f}, {0.3f, 0.6f}, {0.15f, 0.06f}, {0.3127f, 0.329f}};

Eigen::Vector3d XyzOf(const Vec2f& xy) {
    return {double(xy.x()), double(xy.y()), 1 - double(xy.x()) - double(xy.y())};
}

// Of luminance 1.
Eigen::Vector3d WhiteOf(const Primaries& p) { return XyzOf(p.white) / double(p.white.y()); }

Eigen::Matrix3d XyzFrom(const Primaries& p) {
    Eigen::Matrix3d columns;
    columns << XyzOf(p.red), XyzOf(p.green), XyzOf(p.blue);
    return columns * Eigen::Vector3d(columns.inverse() * WhiteOf(p)).asDiagonal();
}

}  // namespace

Eigen::Matrix3f Rec709From(const Primaries& primaries) {
    Eigen::Matrix3d cones;  // Bradford's
    cones << 0.8951, 0.2664, -0.1614, -0.7502, 1.7135, 0.0367, 0.0389, -0.0685, 1.0296;
    const Eigen::Vector3d gain =
        (cones * WhiteOf(kRec709)).cwiseQuotient(cones * WhiteOf(primaries));
    const Eigen::Matrix3d adapted = cones.inverse() * gain.asDiagonal() * cones;
    return (XyzFrom(kRec709).inverse() * adapted * XyzFrom(primaries)).cast<float>();
}

}  // namespace lull
