// Takes samples of the image by the scene's integrator.
#pragma once

#include "renderer/scene/scene.h"
#include "renderer/transport/first_hit.h"

namespace lull {

class GroupRadiance;

// PbrtV3 takes pbrt-v3's strategies as they are: at each vertex one light is chosen and sampled
// both by the light and by a BSDF ray of its own. Combined has the same mean from fewer rays: the
// ray that continues the path is the BSDF sample of the direct light as well, weighed against
// the choice of *any* light.
enum class Estimator { Combined, PbrtV3 };
template <>
struct EnumNames<Estimator> {
    static constexpr std::pair<Estimator, const char*> all[] = {{Estimator::Combined, "combined"},
                                                                {Estimator::PbrtV3, "pbrt-v3"}};
};

// How many samples the strategies of bidirectional path tracing take for one of a pixel.
struct BdptShares {
    float lightPaths = 0;   // that are seen from the camera, in [0, 1]
    float connections = 1;  // subpaths from lights to connect to, in (0, 1]
};

// How paths are traced.
struct PathOptions {
    PathOptions(Estimator estimator) : estimator(estimator) {}

    Estimator estimator = Estimator::Combined;
    // Lets a FirstHit look through mirrors and glass: its albedo is the object's times their
    // reflectance or transmittance, and its depth the length of the path, as if through windows.
    bool throughSpecular = false;
    BdptShares shares = {};  // of scenes with a BdptIntegrator
};

struct PathSample {
    Rgb radiance;   // filter weight and film scale applied: the pixel is the mean of these
    bool rejected;  // was NaN, infinite or of negative luminance, and counts as black
};

// What receives the data of a sample besides its radiance, which they do not change; null: not
// wanted.
struct SampleDetail {
    // The first hit of the path; a path that is at its greatest depth, or ends before it finds
    // something, has none.
    FirstHit* firstHit = nullptr;
    // The radiance by groups of lights, with the same weights.
    GroupRadiance* groups = nullptr;
    // The share of the luminance that comes from connections to subpaths from lights.
    float* connected = nullptr;
};

// Takes sample `index` of `pixel` (full-image coordinates). The result depends on (seed, pixel,
// index) alone, whatever the thread or the order.
PathSample RenderSample(const Scene&, const PathOptions&, Sampler&, const Vec2i& pixel,
                        uint32_t index, const SampleDetail& detail = {});

}  // namespace lull
