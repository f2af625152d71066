// Declares --viewing, the viewing conditions for visible differences.
#pragma once

#include <CLI/App.hpp>

#include "renderer/vision/display_model.h"

namespace lull {

// Adds --viewing; `display` must outlive the parsing.
void AddViewingOption(CLI::App& app, DisplayModel* display);

}  // namespace lull
