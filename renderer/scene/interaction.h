// Holds what is known of a point on a surface once a ray has hit it.
#pragma once

#include "renderer/base/math.h"

namespace lull {

// Says what a material wants to know of a hit beyond position and normals; the scene computes
// nothing else. Bits.
enum SurfaceNeeds : uint8_t {
    kNeedsNothing = 0,
    kNeedsUv = 1,                 // uv
    kNeedsTangents = 2,           // dpdu, dpdv: anisotropy
    kNeedsNormalDerivatives = 4,  // dndu, dndv as well: bump maps
};

struct SurfaceInteraction {
    Vec3f p;       // world
    Vec3f pError;  // bounds on the absolute error of p's coordinates
    Vec3f n;       // geometric, unit, on the side of ns
    Vec3f ns;      // shading, unit; sides as pbrt-v3's, so that it also tells inside from outside
    Vec3f wo;      // towards where the ray came from, unit
    Vec2f uv;
    Vec3f dpdu, dpdv;  // of the shading geometry
    Vec3f dndu, dndv;
    int material = -1;
    int areaLight = -1;  // into the scene's lights; -1: emits nothing

    // Starts a ray here that cannot meet this surface again.
    Ray SpawnRay(const Vec3f& d) const { return {OffsetRayOrigin(p, pError, n, d), d, kInfinity}; }
};

}  // namespace lull
