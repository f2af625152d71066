// Lets commands that render go on where they were interrupted.
#pragma once

#include <CLI/App.hpp>
#include <optional>

#include "renderer/render/checkpoint.h"

namespace lull {

struct CheckpointOptions {
    std::string file;      // empty: none
    double interval = 60;  // seconds
    bool resume = false;
};

// Adds --checkpoint, --checkpoint-interval and --resume.
void AddCheckpointOptions(CLI::App& app, CheckpointOptions* options);

// Throws Error if the file could not be written, or if it is there and not to be resumed from, as
// the render would replace it.
void CheckCheckpoint(const CheckpointOptions&);

// Fills the film and returns the state to go on from; nothing, and a word on stderr, where there
// is no file yet. Throws as ReadCheckpoint() does.
std::optional<RenderState> Resume(const CheckpointOptions&, const RenderIdentity&, Film*,
                                  std::vector<std::byte>* guide = nullptr);

// Lets a render of `film` write its checkpoints. One that cannot be written is a warning on stderr:
// the last good one stays, and so does the render. `guide` is what was learned. All arguments must
// outlive the render.
void WriteCheckpoints(const CheckpointOptions&, const RenderIdentity&, const Film& film,
                      RenderOptions* render, std::span<const std::byte> guide = {});

// Writes the checkpoint of a render that is still learning; a warning on stderr if it cannot be.
void WriteLearningCheckpoint(const CheckpointOptions&, const RenderIdentity&,
                             std::span<const std::byte> guide);

}  // namespace lull
