// Reads numbers that have to be at least 0, of which rounding may have left some just below.
#pragma once

#include <string>

#include "renderer/input/description.h"

namespace lull {

// Returns x, and 0 for what rounding a 0 could leave below it (NotNegative()). Other negative
// numbers and NaN stay as they are.
float RaisedToZero(float x);

// Returns a parameter so. Throws Error with its place for all that is then no finite number of at
// least 0.
float GetNonnegative(const Entity& entity, const std::string& name, float otherwise);

}  // namespace lull
