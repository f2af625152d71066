// Options that several laboratories have.
#pragma once

#include <CLI/App.hpp>

#include <span>
#include <string>

#include "renderer/vision/display_model.h"

namespace lull {

// Adds --split paper:FILE, which sets `file`: the blocks that a model is trained on, and those that
// it is judged by.
void AddSplitOption(CLI::App& app, std::string* file, const std::string& help);

// Adds --viewing, the viewing conditions for visible differences; `display` must outlive the
// parsing.
void AddViewingOption(CLI::App& app, DisplayModel* display);

// Throws CLI::ValidationError if an option was given that is not one of `names`, those that have an
// effect `where`, as "without a SCENE".
void AllowOnly(const CLI::App& app, std::span<const char* const> names, const std::string& where);

}  // namespace lull
