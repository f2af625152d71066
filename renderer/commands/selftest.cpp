// `lull selftest`: checks on the user's own machine that the program computes what it should.
#include <fmt/format.h>
#include <unistd.h>

#include <chrono>
#include <memory>

#include "renderer/base/error.h"
#include "renderer/commands/command.h"
#include "renderer/output/progress.h"
#include "tests/hard_cases/hard_case.h"
#include "tests/hard_cases/heavy_tails.h"

namespace lull {

namespace {

struct SelftestOptions {
    HardCaseOptions cases;
    std::string only;  // a part of the names of those to run; empty: all
    bool markdown = false;
};

double SecondsSince(std::chrono::steady_clock::time_point start) {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

// Shows which case is running, on terminals.
void ShowProgress(size_t done, size_t all, const std::string& name, double seconds) {
    if (!isatty(STDERR_FILENO)) return;
    const std::string left =
        done == 0 ? "" : ", about " + FormatDuration(seconds / double(done) * double(all - done));
    fmt::print(stderr, "\r\x1b[Klull: {} of {} done{}: {}", done, all, left + " left", name);
}

void ClearProgress() {
    if (isatty(STDERR_FILENO)) fmt::print(stderr, "\r\x1b[K");
}

void PrintRow(const HardCase& hardCase, const HardCaseResult& result, bool markdown) {
    const std::string ours =
        NumberText(result.ours) + (result.note.empty() ? "" : " (" + result.note + ")");
    if (markdown)
        fmt::print("| {} | {} | {} | {} | {} |\n", hardCase.name, hardCase.what,
                   NumberText(result.answer), ours, NumberText(result.tolerance));
    else
        fmt::print("{:<6} {:<66} {:>10} {:>9}  {}\n", result.Passed() ? "ok" : "FAILED",
                   hardCase.name, NumberText(result.answer),
                   fmt::format("{:.2g}", result.tolerance), ours);
    std::fflush(stdout);
}

void PrintHeader(bool markdown) {
    if (!markdown) fmt::print("{:<73} {:>10} {:>9}  {}\n", "", "answer", "+-", "ours");
}

void PrintTheme(const std::string& theme, bool markdown) {
    if (markdown)
        fmt::print(
            "\n## {}{}\n\n| case | what goes wrong elsewhere | answer | ours | tolerance |\n"
            "|---|---|---|---|---|\n",
            char(std::toupper(theme[0])), theme.substr(1));
    else
        fmt::print("{}\n", theme);
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
    PrintHeader(options.markdown);
    for (size_t i = 0; i < cases.size(); ++i) {
        ShowProgress(i, cases.size(), cases[i].name, SecondsSince(start));
        const HardCaseResult result = cases[i].run(options.cases);
        ClearProgress();
        if (cases[i].theme != theme) PrintTheme(theme = cases[i].theme, options.markdown);
        PrintRow(cases[i], result, options.markdown);
        failed += !result.Passed();
    }
    fmt::print("\n{} checks, {} failed; seed {}, {}\n", cases.size(), failed, options.cases.seed,
               FormatDuration(SecondsSince(start)));
    return failed == 0 ? kDone : kFailed;
}

}  // namespace

void AddSelftestCommand(CLI::App& app, Command* command) {
    CLI::App* selftest = app.add_subcommand(
        "selftest", "Checks that lull computes what is known, on inputs that are hard.");
    auto options = std::make_shared<SelftestOptions>();
    selftest->add_option("--only", options->only, "Run the checks that have this in their name")
        ->type_name("TEXT");
    selftest
        ->add_option("--seed", options->cases.seed,
                     "Seed of everything random; a failure names one")
        ->capture_default_str();
    selftest->add_flag("--long", options->cases.isLong,
                       "Take 10 to 250 times as many rays and samples, which takes hours");
    selftest->add_flag("--markdown", options->markdown, "Write the table as Markdown");
    selftest->footer(
        "A check passes if what lull computes is at most the tolerance from the answer. What is\n"
        "random has a tolerance of 4.5 standard errors, as measured: one run in 10,000 or so "
        "fails\n"
        "by chance, and passes with another --seed. Exit code 1 if a check fails.\n"
        "Example: lull selftest");
    selftest->callback([=] { *command = [=] { return RunSelftest(*options); }; });
}

}  // namespace lull
