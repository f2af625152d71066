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

// A sample of a pixel, to be taken again and again. The first two members say what is asked for in
// addition to the radiance, which that does not change.
struct PathSample {
    bool asksForHit = false;
    GroupRadiance* groups = nullptr;  // the radiance by groups of lights; null: not asked for

    uint32_t index = 0;
    Rgb radiance =
        Rgb::Zero();        // with filter weight and film scale: the pixel is the mean of these
    bool rejected = false;  // was NaN, infinite or of negative luminance, and counts as black
    // The share of the luminance that comes from connections to subpaths from lights.
    float connected = 0;
    // The first hit of the path, if it is asked for; a path that is at its greatest depth, or ends
    // before it finds something, has none.
    FirstHit hit = {};
};

// Takes sample `index` of `pixel` (full-image coordinates). The result depends on (seed, pixel,
// index) alone, whatever the thread or the order.
void RenderSample(const Scene&, const PathOptions&, Sampler&, const Vec2i& pixel, uint32_t index,
                  PathSample*);
inline PathSample RenderSample(const Scene& scene, const PathOptions& options, Sampler& sampler,
                               const Vec2i& pixel, uint32_t index) {
    PathSample sample;
    RenderSample(scene, options, sampler, pixel, index, &sample);
    return sample;
}

}  // namespace lull
