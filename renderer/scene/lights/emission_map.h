// Varies the emission of a mesh over its surface.
#pragma once

#include "renderer/base/sampling.h"
#include "renderer/scene/geometry/coverage.h"

namespace lull {

// Shared data of the triangles of an emitting mesh. The shape and textures are a scene's.
struct EmissionMap {
    const TextureTable* textures;
    const Shape* shape;
    SpectrumTexture emission;  // multiplies the light's L
    bool secondUv = false;
    bool vertexColors = false;  // multiply it, too
    bool cutsOut = false;       // where the shape's alpha is 0, as rays see it

    // Returns the factor of the radiance at a point of a triangle.
    Rgb At(uint32_t triangle, float b1, float b2) const {
        const Mesh& mesh = *std::get_if<Mesh>(&shape->geometry);
        const Vec2f uv = secondUv ? mesh.Uv1(triangle, b1, b2) : mesh.Uv(triangle, b1, b2);
        Rgb factor = textures->Evaluate(emission, TextureContext{Vec3f::Zero(), uv});
        if (vertexColors) {
            const auto c = mesh.Color(triangle, b1, b2);
            factor *= Rgb(c[0], c[1], c[2]);
        }
        return factor.max(0.f);
    }

    // Returns the same for light sampling, times the probability that a ray hits the surface.
    Rgb Covered(uint32_t triangle, float b1, float b2) const {
        const Rgb e = At(triangle, b1, b2);
        if (cutsOut && IsCutOut(triangle, b1, b2)) return Rgb::Zero();
        if (!shape->coverage) return e;
        return e * CoverageAt(*shape, *textures, Vec3f::Zero(), triangle, b1, b2);
    }

    bool IsCutOut(uint32_t triangle, float b1, float b2) const {
        const Mesh& mesh = *std::get_if<Mesh>(&shape->geometry);
        const auto& p = mesh.corners[triangle].p;
        return textures->Evaluate(*shape->alpha,
                                  TextureContext{(1 - b1 - b2) * p[0] + b1 * p[1] + b2 * p[2],
                                                 mesh.Uv(triangle, b1, b2)}) == 0;
    }

    // Returns the mean over a triangle, from a few points: for the choice of lights only.
    Rgb Mean(uint32_t triangle) const {
        constexpr int kSteps = 4;
        Rgb sum = Rgb::Zero();
        for (int i = 0; i < kSteps; ++i)
            for (int j = 0; j < kSteps; ++j) {
                const Vec2f b = SampleUniformTriangle(
                    {(float(i) + 0.5f) / float(kSteps), (float(j) + 0.5f) / float(kSteps)});
                sum += Covered(triangle, b.y(), 1 - b.x() - b.y());
            }
        return sum / float(kSteps * kSteps);
    }
};

}  // namespace lull
