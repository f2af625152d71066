// Computes how far apart the samples of neighbouring pixels lie on a surface.
#pragma once

#include "renderer/scene/camera.h"
#include "renderer/scene/interaction.h"

namespace lull {

// Fills in dpdx, dpdy, duvdx and duvdy of a hit of the camera ray through `film` and `lens` at
// `time`, from where the rays one pixel to the right and below meet the tangent plane (Igehy 1999;
// pbrt 3rd ed., 10.1). `spacing` is the distance of samples in pixels: pbrt-v3's 1 / sqrt(samples
// per pixel).
void ComputeFootprint(const Camera& camera, const Vec2f& film, const Vec2f& lens, float time,
                      float spacing, SurfaceInteraction* hit);

}  // namespace lull
