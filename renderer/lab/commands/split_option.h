// Lets commands take the blocks that a model is trained on, and those that it is judged by.
#pragma once

#include <CLI/App.hpp>
#include <string>

namespace lull {

// Adds --split paper:FILE, which sets `file`.
void AddSplitOption(CLI::App& app, std::string* file, const std::string& help);

}  // namespace lull
