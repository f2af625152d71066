// Lightness of linear luminances as a display shows them.
#pragma once

#include "stopping/signals/lightness.h"

namespace lull {

// Returns the lightness L, in [0, 100], of the displayed value of a luminance, and its derivative
// by luminance, which is 0 above white.
inline LightnessSlope<float> DisplayedLightness(float y) {
    return y < 1 ? LightnessAt(y) : LightnessSlope<float>{100, 0};
}

}  // namespace lull
