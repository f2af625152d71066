// Says how far from the origin rays are traced, in floats whose squares are still finite. Embree
// takes no ray with a coordinate of more than 1.84e18.
#pragma once

#include "renderer/base/math.h"

namespace lull {

// All that a scene consists of lies within this distance of the origin.
constexpr float kFarthest = 1e17f;

// Rays are traced whose origin and direction are together shorter than this; others miss.
constexpr float kLongestRay = 1e18f;

// Returns the greatest distance of a point of the box from the origin, also where that is beyond
// the squares of floats; 0 for an empty box.
double Farthest(const Bounds3f& box);

// Returns the length up to which rays can be carried by the transform, an affine one: then they are
// no longer than kLongestRay, which is returned where the transform makes nothing longer.
double LongestRayInto(const Mat4d& transform);

}  // namespace lull
