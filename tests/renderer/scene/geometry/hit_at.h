#pragma once

#include "renderer/scene/interaction.h"

namespace lull {

// Returns a hit of a shape of one primitive in the world, as the accelerator tells of it.
inline Hit HitAt(float t) { return {t, 0, 0, 0, 0, -1}; }

}  // namespace lull
