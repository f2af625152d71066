// `lull train --search`: tries all combinations of some options.
#pragma once

#include "renderer/commands/command.h"
#include "renderer/lab/commands/train_options.h"

namespace lull {

// Trains and judges every combination, and writes the tables.
ExitCode RunSearch(const TrainOptions& options);

}  // namespace lull
