// Prints the path of one sample.
#pragma once

#include <CLI/App.hpp>
#include <optional>

#include "renderer/commands/render_settings.h"
#include "renderer/transport/integrator.h"

namespace lull {

struct PathOfSample {
    std::optional<Vec2i> pixel;  // of the whole image, from its upper left; nothing: none is wanted
    int sample = 0;
};

// Adds --pixel and --sample.
void AddPathOptions(CLI::App& app, PathOfSample* options);

// Prints the path of a sample, bounce by bounce, on stdout. Throws UsageError for a pixel that the
// image does not have.
void PrintPath(const PathOfSample&, const RenderSettings&, const Description&, const Scene&);

}  // namespace lull
