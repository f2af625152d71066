// Places a camera so that a scene fills the picture.
#pragma once

#include <array>
#include <vector>

#include "renderer/input/description.h"

namespace lull {

// Returns the points, of three numbers each, that lie farthest out in a hundred directions: a
// view of these contains all points up to a hundredth of their extent.
std::vector<Vec3f> OutlineOf(const std::vector<float>& points);

// Finds from where a camera that looks in one direction sees all points just so.
class Framing {
  public:
    // `azimuth` is in degrees around the vertical, 0 from +z, 90 from +x; `elevation` in
    // degrees above the horizon. `tangents` are of half the field of view, horizontally and
    // vertically.
    Framing(double azimuth, double elevation, const std::array<double, 2>& tangents);

    void Extend(const Vec3f& point);
    // Returns the camera's transform into the world, in glTF's convention: it looks along -z.
    // Without points it looks at a ball of radius 1 around the origin.
    Mat4d WorldFromCamera() const;

  private:
    Eigen::Matrix3d axes;  // right, up, back
    std::array<double, 2> tangents;
    // How far points go along the normals of the picture's four sides, not of unit length: left and
    // right, below and above.
    std::array<std::array<double, 2>, 2> reach;
    double nearest, farthest;  // along back
};

}  // namespace lull
