// Renders scenes with learners for tests.
#pragma once

#include <atomic>
#include <optional>
#include <vector>

#include "renderer/learning/learners.h"
#include "renderer/render/light_rounds.h"
#include "renderer/render/render.h"
#include "tests/renderer/scene_of.h"

namespace lull {

// Returns the mean green of a film.
inline double MeanOf(const Film& film) {
    double sum = 0;
    const std::vector<float> means = film.MeanImage();
    for (size_t i = 1; i < means.size(); i += 3) sum += double(means[i]);
    return sum / double(film.Region().Area());
}

// A render that learns, and what it has learned.
struct LearningRender {
    LearningRender(const Scene& scene, RenderOptions given, LearningOptions how = {})
        : scene(scene),
          options(std::move(given)),
          learner(scene, how, RegionOf(scene).Area()),
          film(RegionOf(scene), {.grid = GridOf(options.schedule),
                                 .withSpreads = IsBidirectional(scene.integrator)}) {
        if (IsBidirectional(scene.integrator))
            light = std::make_unique<LightRounds>(scene, film, options.sampler, options.seed);
        source = SamplesOf(scene, learner, light.get());
    }
    RenderResult Run(const RenderState* interrupted = nullptr) {
        return Render({.source = source,
                       .film = &film,
                       .interrupted = interrupted,
                       .learners = &learner,
                       .lightRounds = light.get(),
                       .checkpoints = checkpoints},
                      options);
    }
    const Guide& TheGuide() const { return *learner.Paths().guide; }
    double Mean() const { return MeanOf(film); }
    // Returns all that was learned, without the time that it took.
    std::vector<std::byte> Learned() const {
        std::vector<std::byte> bytes = learner.Save();
        bytes.resize(bytes.size() - sizeof(double));
        return bytes;
    }

    const Scene& scene;
    RenderOptions options;
    Checkpointing checkpoints;
    Learners learner;
    Film film;
    std::unique_ptr<LightRounds> light;
    SampleSource source;
};

// Renders with interruptions, each after some tiles; every part, which make() returns, continues
// the one before. Returns the last part, and how many there were.
template <typename Make>
auto RenderInParts(const Make& make, int* parts) {
    RenderState state;
    auto part = make();
    for (*parts = 1;; ++*parts) {
        std::atomic<int> asked = 0;
        part->options.isCancelled = [&] { return ++asked > 23 + *parts; };
        part->checkpoints.write = [&](const RenderState& s) { state = s; };
        const RenderState before = state;
        if (!part->Run(*parts > 1 ? &before : nullptr).cancelled) return part;
        auto next = make();
        next->film = part->film;
        next->learner.Take(part->learner.Save(), next->film);
        part = std::move(next);
    }
}

}  // namespace lull
