// Lists the subcommands. Each adds its options to the command line and, if it was given, sets the
// function to run.
#pragma once

#include <CLI/App.hpp>
#include <functional>

#include "renderer/base/error.h"

namespace lull {

enum ExitCode { kDone = 0, kFailed = 1, kWrongUsage = 2, kInterrupted = 130 };

// An invalid command line, whatever the files: kWrongUsage.
class UsageError : public Error {
  public:
    using Error::Error;
};

class Job;

// Does the work of a subcommand and returns the exit code. Throws on errors.
using Command = std::function<ExitCode()>;

// Those that several ranks can share get the job.
void AddRenderCommand(CLI::App& app, Command* command, Job* job);
void AddDatasetCommand(CLI::App& app, Command* command, Job* job);
void AddCompareCommand(CLI::App& app, Command* command, Job* job);
void AddBenchCommand(CLI::App& app, Command* command, Job* job);
void AddInfoCommand(CLI::App& app, Command* command);
void AddTrainCommand(CLI::App& app, Command* command);
void AddEvaluateCommand(CLI::App& app, Command* command);
void AddEntropyCommand(CLI::App& app, Command* command);
void AddSelftestCommand(CLI::App& app, Command* command);
void AddJudgeCommand(CLI::App& app, Command* command);
void AddDenoiseCommand(CLI::App& app, Command* command);

}  // namespace lull
