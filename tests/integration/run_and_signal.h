// Interrupts the program where a user would.
#pragma once

#include <csignal>

#include "tests/integration/run_lull.h"

namespace lull {

// Runs a single command, and sends it `signal` as soon as all of `files`, separated by spaces, have
// been written.
inline Outcome RunAndSignal(const TemporaryDirectory& directory, const std::string& command,
                            int signal, const std::string& files) {
    return RunShell(directory,
                    fmt::format("LD_PRELOAD='{}' RENAMED_FILES='{}' RENAMED_SIGNAL={} {}",
                                SIGNAL_AT_RENAME, files, signal, command));
}

}  // namespace lull
