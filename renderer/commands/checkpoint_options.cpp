#include "renderer/commands/checkpoint_options.h"

#include <CLI/CLI.hpp>

namespace lull {

void AddCheckpointOptions(CLI::App& app, CheckpointOptions* options) {
    auto* file = app.add_option("--checkpoint", options->file,
                                "Keep what is needed to go on after an interruption")
                     ->type_name("F.h5");
    app.add_option("--checkpoint-interval", options->interval, "Seconds between checkpoints")
        ->check(CLI::Range(0.1, 1e6))
        ->type_name("S")
        ->needs(file)
        ->capture_default_str();
    app.add_flag("--resume", options->resume, "Go on from the checkpoint, if it is there")
        ->needs(file);
}

}  // namespace lull
