// The light of a photographer's studio, for scenes that have none of their own.
#pragma once

#include "renderer/image/image.h"

namespace lull {

// Returns a latitude-longitude map: a grey backdrop, brighter above, and three soft boxes. Its +z
// is up, its +x where the camera is, its +y to the right of the camera. A white matte surface that
// faces up or to the camera reflects about 1.
Image MakeStudio();

}  // namespace lull
