#include "renderer/commands/checkpoint_options.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <filesystem>

#include "renderer/commands/aov_options.h"
#include "renderer/output/file_io.h"

namespace lull {

namespace {

// Warns of a checkpoint that could not be written, and returns of what; "" if it was. What `said`
// holds is not said again: a disk stays full for more than one attempt.
std::string TryToWrite(const std::string& file, const RenderIdentity& identity,
                       const RenderState& state, const Film& film, std::span<const std::byte> guide,
                       const AovFilm* aovs, const std::string& said) try {
    WriteCheckpoint(file, identity, state, film, guide, aovs);
    return "";
} catch (const Error& e) {
    if (e.what() != said) fmt::print(stderr, "\nlull: warning: no checkpoint: {}\n", e.what());
    return e.what();
}

}  // namespace

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
                                  Film* film, std::vector<std::byte>* guide) {
    return Resume(options, identity, film, guide, nullptr);
}

std::optional<RenderState> Resume(const CheckpointOptions& options, const RenderIdentity& identity,
                                  Film* film, std::vector<std::byte>* guide, AovFilm* aovs) {
    if (!options.resume) return {};
    if (!std::filesystem::exists(options.file)) {
        fmt::print(stderr, "lull: there is no {} yet: from the start\n", options.file);
        return {};
    }
    RenderState state = ReadCheckpoint(options.file, identity, film, guide, aovs);
    fmt::print(stderr, "lull: going on from {}\n", options.file);
    return state;
}

void WriteCheckpoints(const CheckpointOptions& options, const RenderIdentity& identity,
                      const Film& film, RenderOptions* render, std::span<const std::byte> guide) {
    WriteCheckpoints(options, identity, film, render, guide, nullptr);
}

void WriteCheckpoints(const CheckpointOptions& options, const RenderIdentity& identity,
                      const Film& film, RenderOptions* render, std::span<const std::byte> guide,
                      const AovFilm* aovs) {
    if (options.file.empty()) return;
    render->checkpointInterval = options.interval;
    render->onCheckpoint = [&options, &identity, &film, guide, aovs,
                            said = std::string()](const RenderState& state) mutable {
        said = TryToWrite(options.file, identity, state, film, guide, aovs, said);
    };
}

void WriteLearningCheckpoint(const CheckpointOptions& options, const RenderIdentity& identity,
                             std::span<const std::byte> guide) {
    TryToWrite(options.file, identity, {}, Film(PixelRect()), guide, nullptr, "");
}

}  // namespace lull
