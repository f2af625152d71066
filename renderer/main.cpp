// The command line of lull.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <memory>
#include <new>
#include <system_error>

#include "renderer/base/error.h"
#include "renderer/base/say.h"
#include "renderer/commands/command.h"
#include "renderer/commands/talk.h"
#include "renderer/mpi/job.h"

namespace lull {

namespace {

// The subcommands that render for long.
constexpr std::array sharedCommands = {"render", "compare", "bench", "dataset"};

ExitCode Run(Job* job, const Command& command) {
    std::string message;
    try {
        const ExitCode code = command();
        FinishResults();
        return code;
    } catch (const OtherRankFailed&) {
        return kFailed;
    } catch (const std::bad_alloc&) {
        message = "out of memory; end other programs, or give --crop or a smaller --resolution";
    } catch (const std::system_error& e) {  // as of what prints, which does not say to where
        message = HasLostResults() ? "cannot write the results to stdout: " + e.code().message()
                                   : OneLine(e.what());
    } catch (const std::exception& e) {
        message = OneLine(e.what());
    }
    job->Fail(message);
    return kFailed;
}

ExitCode Main(Job* job, int argc, char** argv) {
    CLI::App app("lull renders pbrt-v3 scenes and stops each part of the image by itself.", "lull");
    app.set_version_flag("--version", "lull " LULL_VERSION);
    app.require_subcommand(1);
    app.footer(
        "Example: lull render scene.pbrt -o image.exr\n"
        "Each subcommand has its own --help.");

    Command command;
    AddRenderCommand(app, &command, job);
    AddDenoiseCommand(app, &command);
    AddInfoCommand(app, &command);
    AddDatasetCommand(app, &command, job);
    AddTrainCommand(app, &command);
    AddEvaluateCommand(app, &command);
    AddSelftestCommand(app, &command);
    AddCompareCommand(app, &command, job);
    AddBenchCommand(app, &command, job);
    AddJudgeCommand(app, &command);
    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& e) {
        const ExitCode code = app.exit(e) == 0 ? kDone : kWrongUsage;
        return Run(job, [code] { return code; });
    }
    const auto isShared = [&](const char* name) { return app.got_subcommand(name); };
    if (job->Count() > 1 && std::ranges::none_of(sharedCommands, isShared))
        command = []() -> ExitCode {
            throw Error(
                "only render, compare, bench and dataset run on several ranks; start this one by "
                "itself");
        };
    return Run(job, command);
}

ExitCode Main(int argc, char** argv) {
    std::unique_ptr<Job> job;
    try {
        job = std::make_unique<Job>();
    } catch (const Error& e) {
        Say("lull: error: {}\n", e.what());
        return kFailed;
    }
    const ExitCode code = Main(job.get(), argc, argv);
    job->EndWithout(code);
    return code;
}

}  // namespace

}  // namespace lull

int main(int argc, char** argv) {
    lull::PrepareStreams();
    return lull::Main(argc, argv);
}
