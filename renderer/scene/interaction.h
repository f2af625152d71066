// The surface point that a ray has hit.
#pragma once

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

// A hit as the accelerator returns it.
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
