#include "renderer/transport/integrator_internal.h"

#include "renderer/base/visit.h"
#include "renderer/transport/group_radiance.h"

namespace lull {

namespace {

// Gives groups the weights of a sample whose radiance was `found`. Out of the way of all others.
[[gnu::noinline]] void Weigh(const Scene& scene, const SampleStart& start, const Rgb& found,
                             bool isRejected, GroupRadiance* groups) {
    if (isRejected) groups->Clear();
    groups->Scale(LimitOf(scene, Luminance(found)));
    groups->Scale(WeightOf(scene, start));
}

}  // namespace

PathSample RenderSample(const Scene& scene, const PathOptions& options, Sampler& sampler,
                        const Vec2i& pixel, uint32_t index, const SampleDetail& detail) {
    const SampleStart start = StartSample(scene, sampler, pixel, index);
    if (detail.firstHit)
        *detail.firstHit = {.weight = start.filter.weight,
                            .offset2 = start.filter.offset.squaredNorm()};
    if (detail.groups) detail.groups->Clear();
    if (detail.connected) *detail.connected = 0;
    if (start.cameraWeight == 0) return {Rgb::Zero(), false};
    const auto li = [&](const auto& integrator) {
        return Li(integrator, scene, options, sampler, start, detail);
    };
    const Rgb found = Visit(scene.integrator, li);
    const PathSample sample = Weighted(scene, start, found);
    if (detail.firstHit) {
        Rgb& emission = detail.firstHit->emission;
        emission *= LimitOf(scene, Luminance(found)) * WeightOf(scene, start);
        if (sample.rejected || !IsFinite(emission)) emission = Rgb::Zero();
    }
    if (detail.groups) Weigh(scene, start, found, sample.rejected, detail.groups);
    return sample;
}

}  // namespace lull
