// Chooses the view of a glTF file.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "renderer/input/description.h"
#include "renderer/input/gltf/document.h"
#include "renderer/input/gltf/nodes.h"

namespace lull {

// Places a camera so that a scene fills the picture.

// Returns the points, of three numbers each, that lie farthest out in a hundred directions: a
// view of these contains all points up to a hundredth of their extent.
std::vector<Vec3f> OutlineOf(const std::vector<float>& points);

// Finds from where a camera that looks in one direction sees all points just so.
class Framing {
  public:
    // `azimuth` is in degrees around the vertical, 0 from +z, 90 from +x; `elevation` above the
    // horizon. `tangents` are of half the field of view, horizontally and vertically.
    Framing(double azimuth, double elevation, const std::array<double, 2>& tangents);

    void Extend(const Vec3f& point);
    // Returns the camera's transform into the world, in glTF's convention: it looks along -z.
    // Without points it looks at a ball of radius 1 around the origin.
    Mat4d WorldFromCamera() const;

  private:
    Eigen::Matrix3d axes;  // right, up, back
    std::array<double, 2> tangents;
    // How far points go along the sides' normals, not unit: left and right, below and above.
    std::array<std::array<double, 2>, 2> reach;
    double nearest, farthest;  // along back
};

// Returns the framing, to be extended by all points of the scene before SetView(), where the
// options ask for a view of all, or there is no camera; else nothing.
std::optional<Framing> FramingFor(const GltfDocument&, const std::vector<GltfNode>&,
                                  const GltfOptions&);

// Sets camera and film: as framed, to the camera that the options name, or to the scene's first.
// The height is 800 pixels. Throws Error for a camera that is not there or sees nothing.
void SetView(const GltfDocument&, const std::vector<GltfNode>&, const std::optional<Framing>&,
             const GltfOptions&, Description*);

}  // namespace lull
