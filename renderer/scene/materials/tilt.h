// Tilts the shading geometry of surfaces by textures.
#pragma once

#include "renderer/scene/interaction.h"
#include "renderer/scene/textures/texture.h"

namespace lull {

// Tilts the shading geometry as a displacement of the surface would.
//
// Turns hit->ns, dpdu and dpdv to those of the surface displaced by the texture along its shading
// normal, which stays on the side of hit->n (Blinn 1978, with the displacement's own term, as
// pbrt-v3). Differences are taken over the step pbrt-v3 uses where it has no ray differentials,
// 0.0005 in u and v. If the result has no normal, the hit stays unchanged.
void ApplyBumpMap(const FloatTexture& displacement, const TextureTable&, SurfaceInteraction* hit);

// Tilts shading normals by an image of normals.
//
// Normals in the frame of the surface's tangents, each coordinate from -1 to 1 stored as 0 to
// 1: x along u, y along v, which grows upwards in the image (glTF 2.0, 3.9.3).
struct NormalMap {
    SpectrumTexture texture;
    float scale = 1;        // of x and y
    bool secondUv = false;  // which texture coordinates it is looked up with
};

// Turns hit->ns, and the tangents with it, as the map says. The hit needs tangents. It stays
// unchanged if the result has no direction or points below the surface.
void ApplyNormalMap(const NormalMap&, const TextureTable&, SurfaceInteraction* hit);

}  // namespace lull
