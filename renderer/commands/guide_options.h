// Lets a render be guided.
#pragma once

#include <CLI/App.hpp>
#include <functional>

#include "renderer/commands/render_settings.h"
#include "renderer/render/learning.h"

namespace lull {

struct GuideOptions {
    GuideMode mode = GuideMode::Off;
    int megabytes = 64;
};

// Adds --guide and --guide-memory.
void AddGuideOptions(CLI::App& app, GuideOptions* options);

// Says what a render needs for learning, beside the options.
struct LearningContext {
    const Scene& scene;
    const PixelRect& region;
    const RenderSettings& settings;  // with the cap of the rule
    SamplerKind sampler;
    int ranks = 1;
    // Returns the seconds that the render has left; can be empty. Learning takes a part of them.
    std::function<double()> clock;
    // Gets what to go on from, after each round; can be empty.
    std::function<void(std::span<const std::byte>)> keep;
    // What `keep` got last of an interrupted render; can be empty.
    std::span<const std::byte> kept;
};

// Throws Error where the scene cannot be guided but --guide on asks for it.
void CheckGuide(const GuideOptions&, const Scene&, Estimator);

// Learns, and says so on stderr. Returns nothing if it was interrupted. Several ranks each learn
// all, to the same bits. Throws as CheckGuide() does.
std::optional<Learning> LearnGuide(const GuideOptions&, const LearningContext&);

}  // namespace lull
