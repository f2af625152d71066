// Shared code of sphere.cpp and disk.cpp.
#pragma once

#include <utility>

#include "renderer/scene/geometry/shapes/quadric.h"

namespace lull {

using PointWithError = std::pair<Vec3f, Vec3f>;

Bounds3f TransformBounds(const Mat4d& m, const Vec3f& lower, const Vec3f& upper);

// Transforms a point with absolute error bounds, and bounds the error of the result.
PointWithError TransformWithError(const Mat4d& m, const Vec3f& p, const Vec3f& error);

// Transforms the point, the normal and, where needed, hit->dpdu ... dndv from shape space to world
// space.
void FinishQuadricHit(const QuadricPlacement&, const Vec3f& pShape, const Vec3f& errorShape,
                      const Vec3f& nShape, SurfaceNeeds, SurfaceInteraction* hit);

// A ray in shape space, in double; the direction keeps its length so that t is the same.
struct ShapeRay {
    Eigen::Vector3d o, d;

    ShapeRay(const QuadricPlacement& place, const Ray& ray)
        : o(place.shapeFromWorld.topLeftCorner<3, 3>() * ray.o.cast<double>() +
            place.shapeFromWorld.topRightCorner<3, 1>()),
          d(place.shapeFromWorld.topLeftCorner<3, 3>() * ray.d.cast<double>()) {}
    Eigen::Vector3d operator()(double t) const { return o + t * d; }
};

// Returns the azimuth of p in [0, 2 pi).
inline float Azimuth(double x, double y) {
    const float phi = float(std::atan2(y, x));
    return phi < 0 ? phi + 2 * kPi : phi;
}

}  // namespace lull
