// Tilts the shading geometry as a displacement of the surface would.
#pragma once

#include "renderer/scene/interaction.h"
#include "renderer/scene/textures/texture.h"

namespace lull {

// Turns hit->ns, dpdu and dpdv to those of the surface displaced by the texture along its shading
// normal, which stays on the side of hit->n (Blinn 1978, with the displacement's own term, as
// pbrt-v3). Differences are taken over the step pbrt-v3 uses where it has no ray differentials,
// 0.0005 in u and v. If the result has no normal, the hit stays unchanged.
void ApplyBumpMap(const FloatTexture& displacement, const TextureTable&, SurfaceInteraction* hit);

}  // namespace lull
