// Represents spheres and disks, which are intersected exactly, in their own space.
#pragma once

#include <optional>

#include "renderer/scene/geometry/shapes/shape_sample.h"
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

}  // namespace lull
