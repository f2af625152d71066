// Computes the coverage of a mesh at a point.
#pragma once

#include "renderer/scene/geometry/shape.h"

namespace lull {

// Returns the probability, in [0, 1], that a ray hits the shape at this point of a triangle. The
// shape is a mesh with coverage.
inline float CoverageAt(const Shape& shape, const TextureTable& textures, const Vec3f& p,
                        uint32_t triangle, float b1, float b2) {
    const Coverage& coverage = *shape.coverage;
    const Mesh& mesh = *std::get_if<Mesh>(&shape.geometry);
    float alpha = coverage.factor;
    if (!coverage.alpha.IsConstant()) {
        const Vec2f uv = coverage.secondUv ? mesh.Uv1(triangle, b1, b2) : mesh.Uv(triangle, b1, b2);
        alpha *= textures.Evaluate(coverage.alpha, TextureContext{p, uv});
    } else {
        alpha *= coverage.alpha.constant;
    }
    if (coverage.vertexAlpha) alpha *= mesh.Color(triangle, b1, b2)[3];
    if (coverage.cutoff >= 0) return alpha >= coverage.cutoff ? 1 : 0;
    return std::clamp(alpha, 0.f, 1.f);
}

}  // namespace lull
