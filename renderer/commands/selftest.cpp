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
#include "renderer/commands/render_settings.h"
#include "renderer/progress/progress.h"
#include "stopping/rules/learned.h"
#include "tests/hard_cases/hard_case.h"
#include "tests/hard_cases/heavy_tails.h"

namespace lull::selftest {

namespace {

struct SelftestOptions {
    HardCaseOptions cases;
    std::string only;  // a part of the names of those to run; empty: all
    std::string model = ModelFolder() + "/" + kDefaultModelName + ".h5";
    bool markdown = false;
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

void PrintHeader(const SelftestOptions& options) {
    if (!options.markdown) {
        fmt::print("{:<73} {:>10} {:>9}  {}\n", "", "answer", "+-", "ours");
        return;
    }
    fmt::print(
        "# Hard cases\n\n"
        "Inputs that are built to break a path tracer or a stopping rule, each with its answer "
        "known. The program wrote this\npage, with\n\n"
        "    lull selftest --markdown{} >tests/hard_cases/README.md\n\n"
        "`lull selftest` checks the same on any machine in a minute, and the tests do. A case "
        "passes if ours is at most the\ntolerance from the answer. Radiance is rendered with both "
        "estimators and shown for the worse; its tolerance is 4.5\nstandard errors as measured, "
        "plus that in the note. Counts of failures have no tolerance at all.\n",
        options.cases.isLong ? " --long" : "");
}

void PrintTheme(const std::string& theme, bool markdown) {
    if (markdown)
        fmt::print(
            "\n## {}{}\n\n| case | failure elsewhere | answer | ours | tolerance |\n"
            "|---|---|---|---|---|\n",
            char(std::toupper(theme[0])), theme.substr(1));
    else
        fmt::print("{}\n", theme);
}

// Shows the bias of rules on samples whose few important values are rare.
void PrintHeavyTails(const SelftestOptions& options) {
    fmt::print(
        "\n## Bias of stopped images\n\n"
        "A rule that checks the samples it stops tends to stop while bright ones are still "
        "missing: "
        "the image is then too dark.\nConditions: 100 x 100 independent pixels of mean 0.25, "
        "passes "
        "of 20 spp, at most 10,000. Bias is that of the block's\nmean, known to 0.07 % at the cap. "
        "Error is the relative RMS over the pixels. Unseen is the fraction of pixels without\na "
        "sample of the rare light at the stop.\n");
    std::vector<std::string> rules = UsualRules();
    for (const char* loose : {"dammertz:0.1", "cycles:0.1", "luxtile:0.1", "lnoise:2", "entropy:2"})
        rules.push_back(loose);
    rules.push_back("learned:" + options.model);
    for (const Tail& tail : HeavyTails()) {
        fmt::print(
            "\n{}:\n\n| rule | stops at spp | bias, % | error, % | unseen, % |\n"
            "|---|---|---|---|---|\n",
            tail.name);
        const std::vector<StopOutcome> outcomes = StopBlocks(tail, rules, options.cases.seed);
        for (size_t i = 0; i < rules.size(); ++i)
            fmt::print("| {} | {} | {:.2f} | {:.1f} | {} |\n",
                       rules[i].starts_with("learned") ? "learned" : rules[i], outcomes[i].spp,
                       100 * outcomes[i].bias, 100 * outcomes[i].error,
                       tail.rarity > 0 ? fmt::format("{:.1f}", 100 * outcomes[i].unseen) : "-");
    }
    fmt::print(
        "\n`lnoise` does not see fireflies that saturate the display. Where the mean of a pixel or "
        "of one half of its samples\nis beyond white, it takes the noise for invisible.\n");
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
    PrintHeader(options);
    for (size_t i = 0; i < cases.size(); ++i) {
        ShowProgress(i, cases.size(), cases[i].name, SecondsSince(start));
        const HardCaseResult result = cases[i].run(options.cases);
        ClearProgress();
        if (cases[i].theme != theme) PrintTheme(theme = cases[i].theme, options.markdown);
        PrintRow(cases[i], result, options.markdown);
        failed += !result.Passed();
    }
    if (options.markdown) PrintHeavyTails(options);
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
    selftest->add_flag("--markdown", options->markdown,
                       "Print Markdown, with a table of the bias of stopping rules");
    selftest
        ->add_option("--model", options->model,
                     "Use this model of `learned` for that table [the bundled one]")
        ->type_name("MODEL.h5");
    selftest->footer(
        "A check passes if the result is at most the tolerance from the answer. Random results\n"
        "have a tolerance of 4.5 standard errors, as measured: about one run in 10,000 fails\n"
        "by chance, and passes with another --seed. Exit code 1 if a check fails.\n"
        "Example: lull selftest");
    selftest->callback([=] { *command = [=] { return RunSelftest(*options); }; });
}

}  // namespace lull::selftest
