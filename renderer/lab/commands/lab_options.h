// Options that several laboratories have.
#pragma once

#include <CLI/App.hpp>

#include <string>

#include "renderer/vision/display_model.h"

namespace lull {

// Adds --split paper:FILE, which sets `file`: the blocks that a model is trained on, and those that
// it is judged by.
void AddSplitOption(CLI::App& app, std::string* file, const std::string& help);

// Adds --viewing, the viewing conditions for visible differences; `display` must outlive the
// parsing.
void AddViewingOption(CLI::App& app, DisplayModel* display);

}  // namespace lull
