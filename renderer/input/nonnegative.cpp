#include "renderer/input/nonnegative.h"

#include <fmt/format.h>

#include <cmath>

#include "renderer/base/rounding.h"

namespace lull {

float RaisedToZero(float x) { return float(NotNegative(double(x)).value_or(double(x))); }

float GetNonnegative(const Entity& entity, const std::string& name, float otherwise) {
    const float value = RaisedToZero(entity.parameters.GetFloat(name, otherwise));
    if (!(value >= 0) || !std::isfinite(value))
        throw Error(entity.loc, fmt::format("\"{}\" is {}; it has to be at least 0", name, value));
    return value;
}

}  // namespace lull
