// Parameters of materials that shapes set for themselves.
#pragma once

#include <optional>

#include "renderer/input/description.h"

namespace lull {

// Returns the material of a shape that has parameters of materials itself: they replace those of
// `material`, as in pbrt-v3. Nothing is returned where the shape has none.
std::optional<MaterialEntity> MaterialOfShape(const MaterialEntity& material,
                                              const ShapeEntity& shape);

}  // namespace lull
