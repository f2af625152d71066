// Represents curves as pbrt-v3 has them, for hair and fur: cubic Bezier curves with a width.
#pragma once

#include <array>
#include <vector>

#include "renderer/scene/geometry/shapes/quadric.h"

namespace lull {

// Flat curves face every ray; so do cylinders, with the normals of tubes; ribbons have normals.
enum class CurveKind { Flat, Cylinder, Ribbon };

// A Bezier curve. Its width changes linearly from u = 0 to u = 1.
struct CurvePiece {
    std::array<Vec3f, 4> p;
    std::array<float, 2> width;
};

// Curves of one kind, in world space (or in their object's). Each piece is 2^splitDepth
// primitives, so that the boxes around them are small; primitive i is part i mod 2^splitDepth of
// piece i / 2^splitDepth.
struct Curves {
    CurveKind kind = CurveKind::Flat;
    int splitDepth = 3;
    std::vector<CurvePiece> pieces;
    std::vector<std::array<Vec3f, 2>> normals;  // of ribbons, at both ends of each piece; unit
    bool flipNormals = false;                   // reverseOrientation xor the transform mirrors
    // How far rays start from a curve, per coordinate and width. pbrt-v3's 2 in shape space.
    Vec3f errorPerWidth = Vec3f::Constant(2);
    // If a transform stretches or mirrors, width and sides are those in shape space, in which the
    // pieces are then given.
    std::optional<QuadricPlacement> place;

    uint32_t PrimitiveCount() const { return uint32_t(pieces.size()) << splitDepth; }
    Bounds3f WorldBounds() const;
    Bounds3f WorldBounds(uint32_t primitive) const;
};

// Returns the point at t of the way from a to b.
inline Vec3f Between(float t, const Vec3f& a, const Vec3f& b) { return (1 - t) * a + t * b; }

// See shape.h. The piece is halved until it is straight to within a twentieth of its width; the hit
// is where it is nearest to the ray in the plane perpendicular to the ray, as in pbrt-v3 (Nakamaru
// and Ohno 2002): u runs along the piece, v across it, both from 0 to 1. A width of 0 is not hit.
std::optional<ShapeHit> Intersect(const Curves&, uint32_t primitive, const Ray&);

// All is filled in, needed or not.
void Interact(const Curves&, const Ray&, const Hit&, SurfaceNeeds, SurfaceInteraction*);

}  // namespace lull
