#include "renderer/commands/checkpoint_options.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <filesystem>

#include "renderer/output/file_io.h"

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

void CheckCheckpoint(const CheckpointOptions& options) {
    if (options.file.empty()) return;
    CheckWritable(options.file);
    if (!options.resume && std::filesystem::exists(options.file))
        throw Error(options.file +
                    ": is there already; give --resume to go on from it, or remove it");
}

std::optional<RenderState> Resume(const CheckpointOptions& options, const RenderIdentity& identity,
                                  Film* film) {
    if (!options.resume) return {};
    if (!std::filesystem::exists(options.file)) {
        fmt::print(stderr, "lull: there is no {} yet: from the start\n", options.file);
        return {};
    }
    RenderState state = ReadCheckpoint(options.file, identity, film);
    fmt::print(stderr, "lull: going on from {}\n", options.file);
    return state;
}

void WriteCheckpoints(const CheckpointOptions& options, const RenderIdentity& identity,
                      const Film& film, RenderOptions* render) {
    if (options.file.empty()) return;
    render->checkpointInterval = options.interval;
    render->onCheckpoint = [&](const RenderState& state) {
        try {
            WriteCheckpoint(options.file, identity, state, film);
        } catch (const Error& e) {
            fmt::print(stderr, "\nlull: warning: no checkpoint: {}\n", e.what());
        }
    };
}

}  // namespace lull
