// Groups the options in the help of commands that read a scene.
#pragma once

#include <CLI/App.hpp>

namespace lull {

// Adds --help-all to a command. Where the command reads a scene, --help-all lists its options by
// subject, and --help only the common ones and those that no other command has.
void GroupOptions(CLI::App* command);

}  // namespace lull
