// The help of the program and its commands. It is the same with all versions of CLI11: the manual
// page, the completion of shells and the reference are made from it.
#pragma once

#include <CLI/CLI.hpp>

namespace lull {

// Gives the program its help; before it has commands and options.
void SetProgramHelp(CLI::App* program);

// Gives a command its help. Where it has common options, --help lists these, and those that no
// other command has; --help-all lists all by subject.
void SetHelp(CLI::App* command);

}  // namespace lull
