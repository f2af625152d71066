// Spheres, disks and surfaces that turn about an axis, intersected exactly, in their own space.
#pragma once

#include <optional>
#include <utility>

#include "renderer/scene/interaction.h"

namespace lull {

// Common part of these shapes: a place in world space (or in their object's).
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

using PointWithError = std::pair<Vec3f, Vec3f>;

// Transforms a point with absolute error bounds, and bounds the error of the result.
PointWithError TransformWithError(const Mat4d& m, const Vec3f& p, const Vec3f& error);

// Makes the sample of a point in shape space, with its error bounds, the normal there, and `pdf`.
ShapeSample SampleAt(const QuadricPlacement&, const Vec3f& p, const Vec3f& error, const Vec3f& n,
                     float pdf);

// Transforms the point, the normal and, where needed, hit->dpdu ... dndv to world space.
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

// Cylinders, cones, paraboloids and hyperboloids: a line or a parabola turned about the z axis.

// Represents {x^2 + y^2 = r2[0] + r2[1] z + r2[2] z^2, zMin <= z <= zMax, phi <= phiMax}. The curve
// that turns starts at `start` (v = 0) and ends at `end` (v = 1); phi is measured from it.
struct Revolved {
    QuadricPlacement place;
    bool isParabola = false;  // the curve; else a straight line
    bool isOnSurface = true;  // the curve; else dpdv is the line's, and the normal dpdu x dpdv
    Eigen::Vector3d start = Eigen::Vector3d::Zero(), end = Eigen::Vector3d::Zero();
    Eigen::Vector3d r2 = Eigen::Vector3d::Zero();
    double zMin = 0, zMax = 0;
    float phiMax = 2 * kPi;
    double normalSign = 1;  // of dpdu x dpdv against the gradient of x^2 + y^2 - r2(z)

    uint32_t PrimitiveCount() const { return 1; }
    Bounds3f WorldBounds() const;
    NormalBounds Normals() const { return {}; }
    float Area() const;  // of cylinders alone
};

// Make the shapes from their sizes (pbrt 3rd ed., 3.3 and 3.5). The cylinder stands on zMin; the
// cone has its tip at `height`; the paraboloid touches the origin and has `radius` at zMax; the
// hyperboloid is pbrt-v3's. `phiMax` in radians. The result has no area, and must not be used,
// where HasArea says so.
//
// pbrt-v3's hyperboloid is swept by the line from p1 to p2 only where the line's waist is at z = 0:
// its waist always is, and it goes through p2 and the point as far behind p2 as p1 is before it.
// Heights end where the line does, which also gives uv, tangents and normals.
Revolved MakeCylinder(float radius, float zMin, float zMax, float phiMax);
Revolved MakeCone(float radius, float height, float phiMax);
Revolved MakeParaboloid(float radius, float zMin, float zMax, float phiMax);
Revolved MakeHyperboloid(const Vec3f& p1, const Vec3f& p2, float phiMax);
bool HasArea(const Revolved&);

// See shape.h. Only cylinders are sampled: uniformly by area.
std::optional<float> Intersect(const Revolved&, const Ray&);
void Interact(const Revolved&, const Ray&, const Hit&, SurfaceNeeds, SurfaceInteraction*);
std::optional<ShapeSample> Sample(const Revolved&, const Vec3f& from, const Vec2f& u);
ShapeSample SampleArea(const Revolved&, const Vec2f& u);
float Pdf(const Revolved&, const Vec3f& from, const Vec3f& p, const Vec3f& n);

}  // namespace lull
