// A render without a scene that keeps the inputs of a denoiser.
#pragma once

#include "tests/renderer/render/synthetic_samples.h"

namespace lull {

inline const PixelRect kPictureRegion = {{3, 5}, {63, 45}};

struct FeatureRender {
    Film film{kPictureRegion, {.layers = {.features = true}}};

    explicit FeatureRender(int threads, int spp = 36,
                           const SampleSource& source = SyntheticSample) {
        RenderOptions options;
        options.schedule = {.blockSize = 30, .passLength = 6, .cap = spp};
        options.threads = threads;
        options.makeCriterion = [](const BlockInfo&) {
            return std::make_unique<ScriptedCriterion>(1000);
        };
        Render({.source = source, .film = &film}, options);
    }
};

}  // namespace lull
