// Computes how far apart the samples of neighbouring pixels lie on a surface.
#pragma once

#include "renderer/scene/cameras/camera.h"
#include "renderer/scene/interaction.h"

namespace lull {

// Fills in dpdx, dpdy, duvdx and duvdy of a hit of the sample's camera ray, from where the rays one
// pixel to the right and below meet the tangent plane (Igehy 1999; pbrt 3rd ed., 10.1). Samples lie
// Camera::sampleSpacing apart.
void ComputeFootprint(const Camera&, const CameraSample&, SurfaceInteraction* hit);

}  // namespace lull
