// What happens to a ray in a medium.
#pragma once

#include <optional>

#include "renderer/base/math.h"

namespace lull {

struct MediumSample {
    std::optional<float> t =
        {};                    // where the ray scatters, in units of its direction; none: it passes
    Rgb weight = Rgb::Ones();  // what the path's throughput is multiplied by, either way
};

}  // namespace lull
