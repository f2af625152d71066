// The light that each strategy of bidirectional path tracing finds at a subpath from the camera,
// with its weight among all strategies (power heuristic).
#pragma once

#include "renderer/transport/bdpt_context_internal.h"
#include "renderer/transport/path_state.h"
#include "renderer/transport/subpath.h"

namespace lull {

// Returns the weight of light that the ray of a camera's subpath has found, of density `origin`
// among those of emitted light. `direct` is the density, 1/sr, of sampling it at the last vertex.
double EmissionWeight(const Segment& segment, double density, double fewer, float direct,
                      const EmissionDensity& emission);

// Returns the light of the surface, a light's, weighted.
Rgb EmittedLight(const BdptContext& context, const Segment& segment, const SurfaceInteraction& hit,
                 const Hit& found, const Arrival& arrival, const LightChoice& choice);

// Returns the light that sampling a light, whose number `chosen` receives, brings to the vertex.
Rgb SampledLight(const BdptContext& context, const SubpathVertex& v, const LightChoice& choice,
                 int* chosen);

// Returns the light that goes from vertex y of a subpath from a light to z, one from the camera's.
Rgb ConnectedLight(const BdptContext& context, const SubpathVertex& z, const SubpathVertex& y);

// Returns the light of the sky that leaves the scene, weighted; tells the recorder of each light.
template <typename Recorder>
Rgb LeavingLight(const BdptContext& context, const Segment& segment, const LightChoice& choice,
                 const Path& path, Recorder& recorder) {
    const Scene& scene = context.scene;
    Rgb sum = Rgb::Zero();
    for (const int i : scene.lights.Infinite()) {
        const auto [L, pdf] = LeAndPdf(scene.lights[i], segment.ray.d);
        if (IsBlack(L)) continue;
        const double across = std::abs(double(segment.n.dot(segment.ray.d)));
        const double fewer = Sqr(across / segment.density) * segment.sum;
        const float direct = segment.connects ? pdf * choice.Pmf(i) : 0;
        const Rgb weighted =
            L * float(EmissionWeight(segment, double(segment.pdf), fewer, direct,
                                     scene.emission->Density(i, Vec3f::Zero(), -segment.ray.d)));
        sum += weighted;
        recorder.FindLight(path, i, weighted);
    }
    return sum;
}

}  // namespace lull
