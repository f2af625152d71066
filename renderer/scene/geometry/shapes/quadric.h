// Represents spheres and disks, which are intersected exactly, in their own space.
#pragma once

#include <optional>

#include "renderer/scene/geometry/shapes/shape_sample.h"
#include "renderer/scene/interaction.h"

namespace lull {

// What spheres and disks have in common: a place in world space (or in their object's).
struct QuadricPlacement {
    Mat4d worldFromShape = Mat4d::Identity(), shapeFromWorld = Mat4d::Identity();
    bool reverseOrientation = false;
    bool flipNormals = false;  // reverseOrientation xor the transform mirrors
};

// Represents {|p| = radius}, clipped to zMin <= z <= zMax and phi <= phiMax (pbrt 3rd ed., 3.2).
struct Sphere {
    QuadricPlacement place;
    float radius = 1, zMin = -1, zMax = 1, phiMax = 2 * kPi;

    Bounds3f WorldBounds() const;
    float Area() const { return phiMax * radius * (zMax - zMin); }
};

// Represents {z = height, innerRadius <= |(x, y)| <= radius, phi <= phiMax} (3.4).
struct Disk {
    QuadricPlacement place;
    float height = 0, radius = 1, innerRadius = 0, phiMax = 2 * kPi;

    Bounds3f WorldBounds() const;
    float Area() const { return 0.5f * phiMax * (Sqr(radius) - Sqr(innerRadius)); }
};

// Return the nearest ray parameter in (0, ray.tMax), if any. Computed in double: a ray that starts
// an error bound away from the surface must find t on the right side of 0.
std::optional<float> Intersect(const Sphere&, const Ray&);
std::optional<float> Intersect(const Disk&, const Ray&);

// Fill in everything about the hit at ray(t) but wo, material and light.
void Interact(const Sphere&, const Ray&, float t, SurfaceNeeds, SurfaceInteraction* hit);
void Interact(const Disk&, const Ray&, float t, SurfaceNeeds, SurfaceInteraction* hit);

// Sample a point as seen from `from`: spheres by the cone they subtend, disks by area. As in
// pbrt-v3, clipping is ignored. The placement must have no scale.
std::optional<ShapeSample> Sample(const Sphere&, const Vec3f& from, const Vec2f& u);
std::optional<ShapeSample> Sample(const Disk&, const Vec3f& from, const Vec2f& u);

// Returns the normal that samples of the disk have.
Vec3f SampledNormal(const Disk&);

// Return the density, 1/sr, with which Sample finds the point p of the shape with normal n.
float Pdf(const Sphere&, const Vec3f& from, const Vec3f& p, const Vec3f& n);
float Pdf(const Disk&, const Vec3f& from, const Vec3f& p, const Vec3f& n);

}  // namespace lull
