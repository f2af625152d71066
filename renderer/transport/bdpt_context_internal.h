// What bidirectional path tracing knows of a sample, or of a light path.
#pragma once

#include "renderer/transport/bdpt.h"

namespace lull {

// Its referents must outlive it.
struct BdptContext {
    const Scene& scene;
    const BdptIntegrator& integrator;
    Sampler& sampler;
    float time;
    double lightPaths;   // for each sample of all pixels
    double connections;  // the probability of a subpath from a light

    // Return c(1) of subpaths from the camera, and c(i) of all others beyond.
    double SeenFromCamera() const { return Sqr(lightPaths); }
    double Connected(bool connects) const { return connects ? Sqr(connections) : 0; }
};

// The most vertices of a subpath from a light.
inline constexpr int kMostVertices = BdptIntegrator::kMostBounces;

// Returns the context of a scene with a BdptIntegrator.
inline BdptContext ContextOf(const Scene& scene, const BdptShares& shares, Sampler& sampler,
                             float time) {
    return {scene,
            std::get<BdptIntegrator>(scene.integrator),
            sampler,
            time,
            LightPathCount(scene, shares),
            double(shares.connections)};
}

}  // namespace lull
