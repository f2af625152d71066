// Limits how far from the origin a scene may go. Embree takes no ray with a coordinate of more than
// 1.84e18, and finds no triangle where products of three lengths are beyond floats. That is made
// sure of where rays come from, and costs those between surfaces nothing.
#pragma once

#include "renderer/base/math.h"

namespace lull {

// All that a scene consists of lies within this distance of the origin, so that no ray that starts
// there and ends there is longer than kLongestRay.
constexpr float kFarthest = 1e12f;
constexpr float kLongestRay = 1e18f;

// Embree takes hits of triangles of less than 1e-18 square units for hits of their first corner: a
// scene of triangles has to be larger than this.
constexpr float kSmallestScene = 1e-6f;

// Returns the greatest distance of a point of the box from the origin, also where that is beyond
// the squares of floats; 0 for an empty box.
double Farthest(const Bounds3f& box);

// Returns the distance within which things may lie so that rays between them can be carried by the
// transform, an affine one; kFarthest at most. It may be negative.
double ReachThrough(const Mat4d& transform);

// Returns whether an affine transform can be inverted by Cramer's rule in floats, as Embree does:
// the products of two and of three lengths are floats.
bool IsInvertibleInFloats(const Mat4d& transform);

}  // namespace lull
