// Lets a render be guided.
#pragma once

#include <CLI/App.hpp>

#include "renderer/render/guide_learning.h"

namespace lull {

// Adds --guide and --guide-memory.
void AddGuideOptions(CLI::App& app, GuideOptions* options);

}  // namespace lull
