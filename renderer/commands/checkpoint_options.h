// Lets commands that render go on where they were interrupted.
#pragma once

#include <CLI/App.hpp>

#include "renderer/render/session.h"

namespace lull {

// Adds --checkpoint, --checkpoint-interval and --resume.
void AddCheckpointOptions(CLI::App& app, CheckpointOptions* options);

}  // namespace lull
