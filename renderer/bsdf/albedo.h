// Says what colour a surface has, whatever the light.
#pragma once

#include "renderer/bsdf/bsdf.h"

namespace lull {

// Estimates the share of even light that is scattered to wo (world, unit), by colour in [0, 1]: as
// EstimatedAlbedo() does, of all lobes together. What denoisers take for albedo.
Rgb AlbedoOf(const Bsdf& bsdf, const Vec3f& wo);

}  // namespace lull
