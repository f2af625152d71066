// Renders scenes with a learner for tests.
#pragma once

#include <atomic>
#include <optional>
#include <vector>

#include "renderer/learning/guide_learning.h"
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
          film(RegionOf(scene), {.grid = GridOf(options.schedule)}),
          source(SamplesOf(scene, learner)) {}
    RenderResult Run(const RenderState* interrupted = nullptr) {
        return Render({.source = source,
                       .film = &film,
                       .interrupted = interrupted,
                       .learner = &learner,
                       .checkpoints = checkpoints},
                      options);
    }
    const Guide& TheGuide() const { return *learner.Paths().guide; }
    double Mean() const { return MeanOf(film); }

    const Scene& scene;
    RenderOptions options;
    Checkpointing checkpoints;
    GuideLearner learner;
    Film film;
    SampleSource source;
};

// Renders with interruptions, each after some tiles; every part, which make() returns, continues
// the one before. Calls use(part, isDone) after each and returns the number of parts.
template <typename Make, typename Use>
int RenderInParts(const Make& make, const Use& use) {
    RenderState state;
    std::optional<Film> film;
    std::vector<std::byte> kept;
    int parts = 0;
    for (bool isDone = false; !isDone; ++parts) {
        auto part = make();
        if (film) {
            part.film = *film;
            part.learner.Take(kept, part.film);
        }
        std::atomic<int> asked = 0;
        part.options.isCancelled = [&] { return ++asked > 23; };
        part.checkpoints.write = [&](const RenderState& s) { state = s; };
        isDone = !part.Run(film ? &state : nullptr).cancelled;
        film = part.film;
        kept = part.learner.Save();
        use(part, isDone);
    }
    return parts;
}

}  // namespace lull
