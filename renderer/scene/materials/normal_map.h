// Tilts shading normals by an image of normals.
#pragma once

#include "renderer/scene/interaction.h"
#include "renderer/scene/textures/texture.h"

namespace lull {

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
