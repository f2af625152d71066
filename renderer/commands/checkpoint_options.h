// Options of checkpoints, for commands that render.
#pragma once

#include <CLI/App.hpp>

#include "renderer/files/outputs.h"
#include "renderer/render/session.h"

namespace lull {

// Adds --checkpoint, --checkpoint-interval and --resume.
void AddCheckpointOptions(CLI::App& app, CheckpointOptions* options);

// Adds --checkpoint-interval alone, for commands that name the file themselves.
CLI::Option* AddCheckpointInterval(CLI::App& app, CheckpointOptions* options);

// Returns the options of a render that resumes from the file without being told to.
CheckpointOptions ResumeIfThere(const std::string& file, double interval);

// Returns exclusive access to a checkpoint, for as long as work may write it. Throws Error if
// another process has it.
FileLock LockCheckpointFile(const std::string& file);

// Throws Error if the file could not be written, or if it is there and not to be resumed from, as
// the render would replace it.
void CheckCheckpoint(const CheckpointOptions&);

// Returns how to continue a render that has ended early: by which command, if it has a checkpoint.
std::string HowToGoOn(const CheckpointOptions&);

// Lets a render end early but in order.

// From now on the first SIGINT, SIGTERM or SIGHUP makes Interrupted() true, and a second one ends
// the program at once with exit code 130; not so a second SIGHUP, as a terminal that is closed
// sends several. Where SIGHUP is ignored, as by nohup, it stays so.
void CatchInterrupts();
bool Interrupted();

}  // namespace lull
