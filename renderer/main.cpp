// The command line of lull.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <new>

#include "renderer/base/error.h"
#include "renderer/commands/command.h"

namespace lull {

namespace {

ExitCode Fail(const std::string& message) {
    fmt::print(stderr, "lull: error: {}\n", message);
    return kFailed;
}

ExitCode Run(const Command& command) try { return command(); } catch (const Error& e) {
    return Fail(e.what());
} catch (const std::bad_alloc&) {
    return Fail("out of memory");
} catch (const std::exception& e) {
    return Fail(e.what());
}

ExitCode Main(int argc, char** argv) {
    CLI::App app("lull renders pbrt-v3 scenes and stops each part of the image by itself.", "lull");
    app.set_version_flag("--version", "lull " LULL_VERSION);
    app.require_subcommand(1);
    app.footer(
        "Example: lull render scene.pbrt -o image.exr\n"
        "Each subcommand has its own --help.");

    Command command;
    AddRenderCommand(app, &command);
    AddInfoCommand(app, &command);
    AddDatasetCommand(app, &command);
    AddTrainCommand(app, &command);
    AddEvaluateCommand(app, &command);
    AddSelftestCommand(app, &command);
    AddCompareCommand(app, &command);
    AddBenchCommand(app, &command);
    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& e) {
        return app.exit(e) == 0 ? kDone : kWrongUsage;
    }
    return Run(command);
}

}  // namespace

}  // namespace lull

int main(int argc, char** argv) { return lull::Main(argc, argv); }
