#include "renderer/transport/integrator_internal.h"

namespace lull {

PathSample RenderSample(const Scene& scene, const PathOptions& options, Sampler& sampler,
                        const Vec2i& pixel, uint32_t index, FirstHit* firstHit) {
    const SampleStart start = StartSample(scene, sampler, pixel, index);
    if (firstHit)
        *firstHit = {.weight = start.filter.weight, .offset2 = start.filter.offset.squaredNorm()};
    if (start.cameraWeight == 0) return {Rgb::Zero(), false};
    const auto li = [&](const auto& integrator) {
        return Li(integrator, scene, options, sampler, start, firstHit);
    };
    return Weighted(scene, start, std::visit(li, scene.integrator));
}

}  // namespace lull
