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

class MpiJob;

// The group of options that --help shows of a command with many; the others are by subject.
inline constexpr const char* kCommonOptions = "Common options";

// Does the work of a subcommand and returns the exit code. Throws on errors.
using Command = std::function<ExitCode()>;

// Each is in a namespace of its own. Those that several ranks can share get the job.
namespace render {
void AddCommand(CLI::App& app, Command* command, MpiJob* job);
}
namespace record {
void AddCommand(CLI::App& app, Command* command, MpiJob* job);
}
namespace compare {
void AddCommand(CLI::App& app, Command* command, MpiJob* job);
}
namespace info {
void AddCommand(CLI::App& app, Command* command);
}
namespace train {
void AddCommand(CLI::App& app, Command* command);
}
namespace evaluate {
void AddCommand(CLI::App& app, Command* command);
}
namespace entropy {
void AddCommand(CLI::App& app, Command* command);
}
namespace selftest {
void AddCommand(CLI::App& app, Command* command);
}
namespace study {
void AddCommand(CLI::App& app, Command* command);
}
namespace denoise {
void AddCommand(CLI::App& app, Command* command);
}

}  // namespace lull
