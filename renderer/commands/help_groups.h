// Sorts the options of a command for its help.
#pragma once

#include <CLI/CLI.hpp>

namespace lull {

// Puts the options that commands share into groups by subject. `--help` then lists the common
// options and those of the command alone, and --help-all, which is added, all of them.
void GroupOptions(CLI::App* command);

}  // namespace lull
