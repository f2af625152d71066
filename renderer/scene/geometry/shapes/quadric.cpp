#include "renderer/scene/geometry/shapes/quadric_internal.h"

#include <tuple>

namespace lull {

Bounds3f TransformBounds(const Mat4d& m, const Vec3f& lower, const Vec3f& upper) {
    Bounds3f bounds;
    for (int corner = 0; corner < 8; ++corner)
        bounds.Extend(TransformPoint(
            m, Vec3f(corner & 1 ? upper.x() : lower.x(), corner & 2 ? upper.y() : lower.y(),
                     corner & 4 ? upper.z() : lower.z())));
    return bounds;
}

PointWithError TransformWithError(const Mat4d& m, const Vec3f& p, const Vec3f& error) {
    // Propagate the point's own error; the arithmetic is double, so only the rounding of the
    // result to float is added.
    const Vec3f q = TransformPoint(m, p);
    const Vec3f propagated =
        (m.topLeftCorner<3, 3>().cwiseAbs() * error.cast<double>()).cast<float>();
    return {q, propagated + Gamma(3) * q.cwiseAbs()};
}

void FinishQuadricHit(const QuadricPlacement& place, const Vec3f& pShape, const Vec3f& errorShape,
                      const Vec3f& nShape, SurfaceNeeds needs, SurfaceInteraction* hit) {
    const Mat4d& m = place.worldFromShape;
    std::tie(hit->p, hit->pError) = TransformWithError(m, pShape, errorShape);
    hit->n = UnitOf(TransformNormal(place.shapeFromWorld, nShape));
    if (place.flipNormals) hit->n = -hit->n;
    hit->ns = hit->n;
    if (!(needs & (kNeedsTangents | kNeedsNormalDerivatives | kNeedsFootprint))) return;
    hit->dpdu = TransformVector(m, hit->dpdu);
    hit->dpdv = TransformVector(m, hit->dpdv);
    hit->surfaceDpdu = hit->dpdu;
    hit->surfaceDpdv = hit->dpdv;
    hit->dndu = TransformNormal(place.shapeFromWorld, hit->dndu);
    hit->dndv = TransformNormal(place.shapeFromWorld, hit->dndv);
}

}  // namespace lull
