// Interrupts the program where a user would.
#pragma once

#include <csignal>

#include "tests/integration/run_lull.h"

namespace lull {

// Runs a single command, which keeps its state in the file `checkpoint`, and sends it `signal` as
// soon as that file has been written.
inline Outcome RunAndSignal(const TemporaryDirectory& directory, const std::string& command,
                            int signal, const std::string& checkpoint) {
    return RunShell(directory, fmt::format("LD_PRELOAD='{}' RENAMED_FILE='{}' RENAMED_SIGNAL={} {}",
                                           SIGNAL_AT_RENAME, checkpoint, signal, command));
}

}  // namespace lull
