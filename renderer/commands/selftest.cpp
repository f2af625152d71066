// `lull selftest`: checks known answers on the user's own machine.
#include <fmt/format.h>
#include <unistd.h>

#include <chrono>
#include <memory>

#include "renderer/base/clocks.h"
#include "renderer/base/error.h"
#include "renderer/base/say.h"
#include "renderer/commands/command.h"
#include "renderer/commands/option_values.h"
#include "renderer/progress/progress.h"
#include "tests/hard_cases/hard_case.h"

namespace lull::selftest {

namespace {

struct SelftestOptions {
    HardCaseOptions cases;
    std::string only;  // a part of the names of those to run; empty: all
};

// Shows which case is running, on terminals.
void ShowProgress(size_t done, size_t all, const std::string& name, double seconds) {
    if (!isatty(STDERR_FILENO)) return;
    const std::string left =
        done == 0 ? "" : ", about " + FormatDuration(seconds / double(done) * double(all - done));
    Say("\r\x1b[Klull: {} of {} done{}: {}", done, all, left + " left", name);
}

void ClearProgress() {
    if (isatty(STDERR_FILENO)) Say("\r\x1b[K");
}

void PrintRow(const HardCase& hardCase, const HardCaseResult& result) {
    const std::string ours =
        NumberText(result.ours) + (result.note.empty() ? "" : " (" + result.note + ")");
    fmt::print("{:<6} {:<66} {:>10} {:>9}  {}\n", result.Passed() ? "ok" : "FAILED", hardCase.name,
               NumberText(result.answer), fmt::format("{:.2g}", result.tolerance), ours);
    std::fflush(stdout);
}

ExitCode RunSelftest(const SelftestOptions& options) {
    std::vector<HardCase> cases = AllHardCases();
    std::erase_if(cases, [&](const HardCase& c) {
        return (c.theme + ": " + c.name).find(options.only) == std::string::npos;
    });
    if (cases.empty()) throw Error("no check has '" + options.only + "' in its name");
    const auto start = std::chrono::steady_clock::now();
    std::string theme;
    size_t failed = 0;
    fmt::print("{:<73} {:>10} {:>9}  {}\n", "", "answer", "+-", "ours");
    for (size_t i = 0; i < cases.size(); ++i) {
        ShowProgress(i, cases.size(), cases[i].name, SecondsSince(start));
        const HardCaseResult result = cases[i].run(options.cases);
        ClearProgress();
        if (cases[i].theme != theme) fmt::print("{}\n", theme = cases[i].theme);
        PrintRow(cases[i], result);
        failed += !result.Passed();
    }
    fmt::print("\n{} checks, {} failed; seed {}, {}\n", cases.size(), failed, options.cases.seed,
               FormatDuration(SecondsSince(start)));
    return failed == 0 ? kDone : kFailed;
}

}  // namespace

void AddCommand(CLI::App& app, Command* command) {
    CLI::App* selftest = app.add_subcommand("selftest", "Checks this build against known answers.");
    auto options = std::make_shared<SelftestOptions>();
    selftest->add_option("--only", options->only, "Run only the checks with TEXT in their name")
        ->type_name("TEXT");
    selftest
        ->add_option("--seed", options->cases.seed,
                     "Seed the random numbers; a failure names its seed")
        ->check(WholeNumber().description(""))
        ->capture_default_str();
    selftest->add_flag("--long", options->cases.isLong,
                       "Take 10 to 250 times as many samples, which takes hours");
    selftest->footer(
        "A check passes if the result is at most the tolerance from the answer. Random results\n"
        "have a tolerance of 4.5 standard errors, as measured: about one run in 10,000 fails\n"
        "by chance, and passes with another --seed. Exit code 1 if a check fails.\n"
        "Example: lull selftest");
    selftest->callback([=] { *command = [=] { return RunSelftest(*options); }; });
}

}  // namespace lull::selftest
