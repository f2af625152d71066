// Lets a render be guided.
#pragma once

#include <CLI/App.hpp>

#include "renderer/learning/learning.h"

namespace lull {

// Adds --guide and --guide-memory.
void AddGuideOptions(CLI::App& app, GuideOptions* options);

// Throws Error where the scene cannot be guided but `--guide on` asks for it.
void CheckGuide(const GuideOptions&, const Scene&, Estimator);

}  // namespace lull
