#include "renderer/transport/group_radiance.h"

#include <algorithm>

namespace lull {

void GroupRadiance::Clear() { std::ranges::fill(All(), Rgb::Zero()); }

void GroupRadiance::Scale(float factor) {
    for (Rgb& radiance : All()) {
        radiance *= factor;
        if (!IsFinite(radiance)) radiance = Rgb::Zero();
    }
}

}  // namespace lull
