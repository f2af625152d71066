// Interaction of a ray with a medium.
#pragma once

#include <optional>

#include "renderer/base/math.h"

namespace lull {

struct MediumSample {
    std::optional<float> t =
        {};                    // where the ray scatters, in units of its direction; none: it passes
    Rgb weight = Rgb::Ones();  // factor of the path's throughput, either way
};

}  // namespace lull
