#include "renderer/transport/integrator.h"

#include <algorithm>

#include "renderer/base/variant.h"
#include "renderer/transport/integrator_internal.h"

namespace lull {

void GroupRadiance::Clear() { std::ranges::fill(All(), Rgb::Zero()); }

void GroupRadiance::Scale(float factor) {
    for (Rgb& radiance : All()) {
        radiance *= factor;
        if (!IsFinite(radiance)) radiance = Rgb::Zero();
    }
}

namespace {

// Gives groups the weights of a sample whose radiance was `found`. Out of the way of all others.
[[gnu::noinline]] void Weigh(const Scene& scene, const SampleStart& start, const Rgb& found,
                             bool isRejected, GroupRadiance* groups) {
    if (isRejected) groups->Clear();
    groups->Scale(LimitOf(scene, found, Luminance(found)));
    for (Rgb& radiance : groups->All()) radiance = Balanced(scene, radiance);
    groups->Scale(WeightOf(scene, start));
}

}  // namespace

void RenderSample(const Scene& scene, const PathOptions& options, Sampler& sampler,
                  const Vec2i& pixel, uint32_t index, PathSample* sample) {
    const SampleStart start = StartSample(scene, sampler, pixel, index);
    sample->index = index;
    sample->connected = 0;
    if (sample->AsksForHits())
        sample->hit = sample->features = {.weight = start.filter.weight,
                                          .offset2 = start.filter.offset.squaredNorm()};
    if (sample->groups) sample->groups->Clear();
    if (start.cameraWeight == 0) {
        sample->radiance = Rgb::Zero();
        sample->rejected = false;
        return;
    }
    const auto li = [&](const auto& integrator) {
        return Li(integrator, scene, options, sampler, start, sample);
    };
    const Rgb found = Visit(scene.integrator, li);
    SetRadiance(scene, start, found, sample);
    if (sample->asksForFeatures) {
        Rgb& emission = sample->features.emission;
        emission = Balanced(scene, emission) *
                   (LimitOf(scene, found, Luminance(found)) * WeightOf(scene, start));
        if (sample->rejected || !IsFinite(emission)) emission = Rgb::Zero();
    }
    if (sample->groups) Weigh(scene, start, found, sample->rejected, sample->groups);
}

}  // namespace lull
