// Points of surfaces: those that a ray has hit, and samples of emitting shapes.
#pragma once

#include <optional>

#include "renderer/base/math.h"

namespace lull {

// Fields of a hit that a material needs beyond position and normals; others are not computed. Bits.
enum SurfaceNeeds : uint16_t {
    kNeedsNothing = 0,
    kNeedsUv = 1,                 // uv
    kNeedsTangents = 2,           // dpdu, dpdv: anisotropy
    kNeedsNormalDerivatives = 4,  // dndu, dndv as well: bump maps
    kNeedsFootprint = 8,          // footprint of the camera ray's pixel: bump maps, noise
    kIsInterface = 16,            // nothing at all: paths go straight on, as nothing scatters
    kNeedsSecondUv = 32,          // uv1
    kNeedsColor = 64,             // color
    kScattersBelow = 128,         // nothing, but transmitted light leaves elsewhere: subsurface
    kLetsThrough = 256,           // nothing, but light may go straight through, as through a pane
};

constexpr SurfaceNeeds operator|(SurfaceNeeds a, SurfaceNeeds b) {
    return SurfaceNeeds(uint16_t(a) | uint16_t(b));
}

struct Hit {
    float t;
    float b1, b2;  // triangles: weights of the second and third vertex; curves: u and v
    int shape;
    uint32_t primitive;
    int instance;  // -1: the shape stands in the world itself
};

// A hit of a shape of several primitives: the place on the ray and on the primitive.
struct ShapeHit {
    float t, u, v;
};

struct ShapeSample {
    Vec3f p, pError, n;  // world; n unit, on the side that emits
    float pdf = 0;       // 1/sr, as seen from the reference point; positive and finite. Or 1/m^2
};

// Bounds normals by a cone about an axis.
struct NormalBounds {
    Vec3f axis = Vec3f::UnitZ();
    float cosAngle = -1;      // -1: any normal
    bool isTwoSided = false;  // the cone about the opposite of the axis as well
};

// Converts a density by area to one by solid angle; 0 if that would not be finite.
inline float SolidAnglePdf(float areaPdf, const Vec3f& from, const Vec3f& p, const Vec3f& n) {
    const Vec3f d = p - from;
    const float distance2 = d.squaredNorm();
    // |cos| = |n.d| / |d|, so the density is areaPdf |d|^3 / |n.d|.
    const float pdf = areaPdf * distance2 * std::sqrt(distance2) / std::abs(n.dot(d));
    return std::isfinite(pdf) ? pdf : 0;
}

// Returns a sample by area with its density as seen from a point; nothing where it is edge-on.
inline std::optional<ShapeSample> SeenFrom(const Vec3f& from, ShapeSample sample) {
    sample.pdf = SolidAnglePdf(sample.pdf, from, sample.p, sample.n);
    if (!(sample.pdf > 0)) return {};
    return sample;
}

struct SurfaceInteraction {
    Vec3f p;       // world
    Vec3f pError;  // bounds on the absolute error of p's coordinates
    Vec3f n;       // geometric, unit, on the side of ns
    Vec3f ns;      // shading, unit; sides as pbrt-v3's, so that it also tells inside from outside
    Vec3f wo;      // towards where the ray came from, unit
    Vec2f uv;
    Vec2f uv1;         // the second set of texture coordinates
    Rgb color;         // of the vertices, interpolated
    Vec3f dpdu, dpdv;  // of the shading geometry
    Vec3f dndu, dndv;
    // For hits of camera rays whose material needs it: the derivatives of the surface itself, how
    // far p moves from one sample to the next across and down the image, and how far uv then moves.
    // The latter stay 0 at all other hits.
    Vec3f surfaceDpdu, surfaceDpdv;
    Vec3f dpdx = Vec3f::Zero(), dpdy = Vec3f::Zero();
    Vec2f duvdx = Vec2f::Zero(), duvdy = Vec2f::Zero();
    int material = -1;
    int areaLight = -1;  // into the scene's lights; -1: emits nothing

    // Starts a ray here that cannot hit this surface again.
    Ray SpawnRay(const Vec3f& d) const { return {OffsetRayOrigin(p, pError, n, d), d, kInfinity}; }
};

}  // namespace lull
