// Prints the page of this folder, README.md: all cases with their results, and the bias that
// stopping rules have on samples of heavy tails. Its argument is the model of `learned`.
#include <fmt/format.h>

#include <cctype>
#include <cstdio>

#include "tests/hard_cases/hard_case.h"
#include "tests/hard_cases/heavy_tails.h"

namespace lull {
namespace {

constexpr const char* kIntroduction =
    "# Hard cases\n\n"
    "Inputs that are built to break a path tracer or a stopping rule, each with its answer known. "
    "A program of\nthis folder wrote the page:\n\n"
    "    cmake --build --preset release --target hard_cases_page\n"
    "    build/release/tests/hard_cases/hard_cases_page stopping/models/entropy.h5 \\\n"
    "        >tests/hard_cases/README.md\n\n"
    "The tests run the same cases. A case passes if ours is at most the tolerance from the answer. "
    "Radiance is rendered with\nboth estimators and shown for the worse; its tolerance is 4.5 "
    "standard errors as measured, plus that in the note. Counts of\nfailures have no tolerance at "
    "all.\n";

constexpr const char* kHeavyTails =
    "\n## Bias of stopped images\n\n"
    "A rule that checks the samples it stops tends to stop while bright ones are still missing: "
    "the "
    "image is then too dark.\nConditions: 100 x 100 independent pixels of mean 0.25, passes of 20 "
    "spp, at most 10,000. Bias is that of the block's\nmean, known to 0.07 % at the cap. Error is "
    "the relative RMS over the pixels. Unseen is the fraction of pixels without\na sample of the "
    "rare light at the stop.\n";

void PrintTheme(const std::string& theme) {
    fmt::print(
        "\n## {}{}\n\n| case | failure elsewhere | answer | ours | tolerance |\n"
        "|---|---|---|---|---|\n",
        char(std::toupper(theme[0])), theme.substr(1));
}

void PrintRow(const HardCase& hardCase, const HardCaseResult& result) {
    const std::string note = result.note.empty() ? "" : " (" + result.note + ")";
    fmt::print("| {} | {} | {} | {}{} | {} |\n", hardCase.name, hardCase.what,
               NumberText(result.answer), NumberText(result.ours), note,
               NumberText(result.tolerance));
}

void PrintTail(const Tail& tail, const std::vector<std::string>& rules, uint64_t seed) {
    fmt::print(
        "\n{}:\n\n| rule | stops at spp | bias, % | error, % | unseen, % |\n"
        "|---|---|---|---|---|\n",
        tail.name);
    const std::vector<StopOutcome> outcomes = StopBlocks(tail, rules, seed);
    for (size_t i = 0; i < rules.size(); ++i)
        fmt::print("| {} | {} | {:.2f} | {:.1f} | {} |\n",
                   rules[i].starts_with("learned") ? "learned" : rules[i], outcomes[i].spp,
                   100 * outcomes[i].bias, 100 * outcomes[i].error,
                   tail.rarity > 0 ? fmt::format("{:.1f}", 100 * outcomes[i].unseen) : "-");
}

void PrintHeavyTails(const std::string& model, uint64_t seed) {
    fmt::print("{}", kHeavyTails);
    std::vector<std::string> rules = UsualRules();
    for (const char* loose : {"dammertz:0.1", "cycles:0.1", "luxtile:0.1", "lnoise:2", "entropy:2"})
        rules.push_back(loose);
    rules.push_back("learned:" + model);
    for (const Tail& tail : HeavyTails()) PrintTail(tail, rules, seed);
    fmt::print(
        "\n`lnoise` does not see fireflies that saturate the display. Where the mean of a pixel or "
        "of one half of its samples\nis beyond white, it takes the noise for invisible.\n");
}

int PrintPage(const std::string& model) {
    const HardCaseOptions options;
    const std::vector<HardCase> cases = AllHardCases();
    int failed = 0;
    std::string theme;
    fmt::print("{}", kIntroduction);
    for (const HardCase& hardCase : cases) {
        if (hardCase.theme != theme) PrintTheme(theme = hardCase.theme);
        const HardCaseResult result = hardCase.run(options);
        PrintRow(hardCase, result);
        std::fflush(stdout);
        failed += !result.Passed();
    }
    PrintHeavyTails(model, options.seed);
    fmt::print("\n{} checks, {} failed; seed {}\n", cases.size(), failed, options.seed);
    return failed > 0;
}

}  // namespace
}  // namespace lull

int main(int count, char** arguments) {
    if (count == 2) return lull::PrintPage(arguments[1]);
    fmt::print(stderr, "usage: hard_cases_page MODEL.h5\n");
    return 1;
}
