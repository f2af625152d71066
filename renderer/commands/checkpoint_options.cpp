#include "renderer/commands/checkpoint_options.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cctype>
#include <cstring>
#include <fstream>
#include <utility>

#include "renderer/base/error.h"
#include "renderer/commands/command.h"
#include "renderer/commands/option_values.h"
#include "renderer/files/file_io.h"
#include "stopping/base/input_file.h"

namespace lull {

namespace {

// Returns a word as one has to type it.
std::string ForShell(const std::string& word) {
    const auto isPlain = [](char c) {
        return std::isalnum(static_cast<unsigned char>(c)) || std::strchr("_-+=./:,@%", c);
    };
    if (!word.empty() && std::ranges::all_of(word, isPlain)) return word;
    std::string quoted = "'";
    for (const char c : word) quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
    return quoted + "'";
}

}  // namespace

CLI::Option* AddCheckpointInterval(CLI::App& app, CheckpointOptions* options) {
    return app
        .add_option("--checkpoint-interval", options->interval,
                    "Save the checkpoint every S seconds")
        ->group("Interruption")
        ->check(Between(0.1, 1e6))
        ->type_name("S")
        ->capture_default_str();
}

void AddCheckpointOptions(CLI::App& app, CheckpointOptions* options) {
    auto* file =
        app.add_option("--checkpoint", options->file, "Save the state of the render, to resume it")
            ->group(kCommonOptions)
            ->type_name("F.h5");
    AddCheckpointInterval(app, options)->needs(file);
    app.add_flag("--resume", options->resume, "Resume from the checkpoint, if it exists")
        ->group(kCommonOptions)
        ->needs(file);
}

CheckpointOptions ResumeIfThere(const std::string& file, double interval) {
    return {.file = file, .interval = interval, .resume = IsThere(file), .isImplied = true};
}

FileLock LockCheckpointFile(const std::string& file) {
    std::optional<FileLock> lock = FileLock::Try(file);
    if (!lock)
        throw Error(
            file +
            ": another process is writing this checkpoint; wait for its end, or name another "
            "file");
    return std::move(*lock);
}

void CheckCheckpoint(const CheckpointOptions& options) {
    if (options.file.empty()) return;
    CheckWritable(options.file);
    if (!options.resume && IsThere(options.file))
        throw Error(options.file + ": already exists; give --resume to continue, or remove it");
}

std::string HowToGoOn(const CheckpointOptions& checkpoint) {
    if (checkpoint.file.empty()) return "with --checkpoint F.h5, it could be resumed";
    std::ifstream file("/proc/self/cmdline");
    std::string command;
    bool resumes = checkpoint.isImplied;
    for (std::string word; std::getline(file, word, '\0');) {
        command += (command.empty() ? "" : " ") + ForShell(word);
        resumes |= word == "--resume";
    }
    return "to resume: " + command + (resumes ? "" : " --resume");
}

}  // namespace lull
