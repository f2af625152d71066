// Represents spheres and disks, which are intersected exactly, in their own space.
#pragma once

#include <optional>
#include <utility>

#include "renderer/scene/interaction.h"

namespace lull {

// Common part of spheres and disks: a place in world space (or in their object's).
struct QuadricPlacement {
    Mat4d worldFromShape = Mat4d::Identity(), shapeFromWorld = Mat4d::Identity();
    bool reverseOrientation = false;
    bool flipNormals = false;  // reverseOrientation xor the transform mirrors
};

// Represents {|p| = radius}, clipped to zMin <= z <= zMax and phi <= phiMax (pbrt 3rd ed., 3.2).
struct Sphere {
    QuadricPlacement place;
    float radius = 1, zMin = -1, zMax = 1, phiMax = 2 * kPi;

    uint32_t PrimitiveCount() const { return 1; }
    Bounds3f WorldBounds() const;
    NormalBounds Normals() const { return {}; }
    float Area() const { return phiMax * radius * (zMax - zMin); }
};

// Represents {z = height, innerRadius <= |(x, y)| <= radius, phi <= phiMax} (3.4).
struct Disk {
    QuadricPlacement place;
    float height = 0, radius = 1, innerRadius = 0, phiMax = 2 * kPi;

    uint32_t PrimitiveCount() const { return 1; }
    Bounds3f WorldBounds() const;
    NormalBounds Normals() const;
    float Area() const { return 0.5f * phiMax * (Sqr(radius) - Sqr(innerRadius)); }
};

// See shape.h.
std::optional<float> Intersect(const Sphere&, const Ray&);
std::optional<float> Intersect(const Disk&, const Ray&);

void Interact(const Sphere&, const Ray&, const Hit&, SurfaceNeeds, SurfaceInteraction*);
void Interact(const Disk&, const Ray&, const Hit&, SurfaceNeeds, SurfaceInteraction*);

// Spheres are sampled by the cone they subtend, disks by area. As in pbrt-v3, clipping is ignored.
std::optional<ShapeSample> Sample(const Sphere&, const Vec3f& from, const Vec2f& u);
std::optional<ShapeSample> Sample(const Disk&, const Vec3f& from, const Vec2f& u);

// By area spheres are sampled where they are not clipped, disks as above.
ShapeSample SampleArea(const Sphere&, const Vec2f& u);
ShapeSample SampleArea(const Disk&, const Vec2f& u);

float Pdf(const Sphere&, const Vec3f& from, const Vec3f& p, const Vec3f& n);
float Pdf(const Disk&, const Vec3f& from, const Vec3f& p, const Vec3f& n);

// Shared code of shapes in their own space.

using PointWithError = std::pair<Vec3f, Vec3f>;

// Transforms a point with absolute error bounds, and bounds the error of the result.
PointWithError TransformWithError(const Mat4d& m, const Vec3f& p, const Vec3f& error);

// Makes the sample of a point in shape space, with its error bounds, the normal there, and `pdf`.
ShapeSample SampleAt(const QuadricPlacement&, const Vec3f& p, const Vec3f& error, const Vec3f& n,
                     float pdf);

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
