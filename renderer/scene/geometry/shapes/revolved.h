// Represents cylinders, cones, paraboloids and hyperboloids: surfaces swept by a line or a parabola
// that turns about the z axis. Intersected exactly, in their own space.
#pragma once

#include "renderer/scene/geometry/shapes/quadric.h"

namespace lull {

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
