// Computes the colour of a surface, whatever the light.
#pragma once

#include "renderer/bsdf/bsdf.h"

namespace lull {

// Estimates the share of uniform light that is scattered to wo (world, unit), per channel in [0,
// 1]: as EstimatedAlbedo() does, for all lobes together. Denoisers use it as albedo.
Rgb AlbedoOf(const Bsdf& bsdf, const Vec3f& wo);

}  // namespace lull
