#include "renderer/scene/cameras/footprint.h"

namespace lull {
namespace {

// Solves d = u dpdu + v dpdv for d in the tangent plane, by its two coordinates along which the
// normal is shortest; 0 where the derivatives are parallel there.
Vec2f ParametersOf(const Vec3f& d, const SurfaceInteraction& hit) {
    int longest;
    hit.n.cwiseAbs().maxCoeff(&longest);
    const int i = longest == 0 ? 1 : 0, j = longest == 2 ? 1 : 2;
    const Vec3f &a = hit.surfaceDpdu, &b = hit.surfaceDpdv;
    const float determinant = a[i] * b[j] - a[j] * b[i];
    const Vec2f uv((d[i] * b[j] - d[j] * b[i]) / determinant,
                   (a[i] * d[j] - a[j] * d[i]) / determinant);
    return uv.allFinite() ? uv : Vec2f(Vec2f::Zero());
}

}  // namespace

void ComputeFootprint(const Camera& camera, const CameraSample& sample, SurfaceInteraction* hit) {
    const float spacing = camera.sampleSpacing;
    const Ray ray = camera.GenerateRay(sample);
    std::array<Vec3f, 2> moves;
    for (int axis = 0; axis < 2; ++axis) {
        const std::optional<Ray> next = camera.NextRay(ray, sample, axis);
        if (!next) return;
        const Vec3f o = ray.o + spacing * (next->o - ray.o);
        const Vec3f d = ray.d + spacing * (next->d - ray.d);
        const float t = hit->n.dot(hit->p - o) / hit->n.dot(d);
        if (!std::isfinite(t)) return;
        moves[axis] = o + t * d - hit->p;
    }
    hit->dpdx = moves[0];
    hit->dpdy = moves[1];
    hit->duvdx = ParametersOf(hit->dpdx, *hit);
    hit->duvdy = ParametersOf(hit->dpdy, *hit);
}

}  // namespace lull
