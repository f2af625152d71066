#include "renderer/commands/checkpoint_options.h"

#include <signal.h>
#include <unistd.h>
#include <CLI/CLI.hpp>

#include <algorithm>
#include <atomic>
#include <cctype>
#include <cstring>
#include <fstream>
#include <utility>

#include "renderer/base/error.h"
#include "renderer/commands/command.h"
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

namespace {

// The one global variable: a signal handler can reach nothing else. Lock-free, hence safe in a
// handler, and visible to all threads, as a plain sig_atomic_t would not be.
std::atomic<bool> interrupted = false;
static_assert(std::atomic<bool>::is_always_lock_free);

extern "C" void OnSignal(int signal) {
    if (interrupted.exchange(true) && signal != SIGHUP) _exit(130);
}

}  // namespace

void CatchInterrupts() {
    struct sigaction action = {};
    action.sa_handler = OnSignal;
    action.sa_flags = SA_RESTART;
    sigemptyset(&action.sa_mask);
    sigaction(SIGINT, &action, nullptr);
    sigaction(SIGTERM, &action, nullptr);
    struct sigaction before = {};
    sigaction(SIGHUP, nullptr, &before);
    if (before.sa_handler != SIG_IGN) sigaction(SIGHUP, &action, nullptr);
}

bool Interrupted() { return interrupted.load(std::memory_order_relaxed); }

}  // namespace lull
