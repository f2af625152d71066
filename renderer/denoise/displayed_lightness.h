// Lightness of linear luminances as a display shows them.
#pragma once

#include "stopping/signals/lightness.h"

namespace lull {

// Returns L, in [0, 100], of what a display shows, and the slope by which luminance changes it,
// which is 0 above white.
inline LightnessSlope<float> DisplayedLightness(float y) {
    return y < 1 ? LightnessAt(y) : LightnessSlope<float>{100, 0};
}

}  // namespace lull
