// Writes the tables of this folder: cases.csv, all cases with their results, and heavy_tails.csv,
// the bias of stopping rules on samples of heavy tails. Prints how many cases failed.
//
//     hard_cases_tables stopping/models/entropy.h5 tests/hard_cases
//
// A case passes if lull's value is within the tolerance of the answer. Radiance is rendered with
// both estimators; the worse is shown. Its tolerance is 4.5 measured standard errors, plus the one
// in the note. Counts of failures have no tolerance at all.
#include <fmt/format.h>

#include <fstream>

#include "tests/hard_cases/hard_case.h"
#include "tests/hard_cases/heavy_tails.h"

namespace lull {
namespace {

// Returns the number of cases that failed. Texts have no quotation marks.
int WriteCases(const std::string& folder, const HardCaseOptions& options) {
    std::ofstream out(folder + "/cases.csv");
    out << "theme,case,failure elsewhere,answer,ours,tolerance,note\n";
    int failed = 0;
    for (const HardCase& hardCase : AllHardCases()) {
        const HardCaseResult result = hardCase.run(options);
        out << fmt::format("{},\"{}\",\"{}\",{},{},{},\"{}\"\n", hardCase.theme, hardCase.name,
                           hardCase.what, NumberText(result.answer), NumberText(result.ours),
                           NumberText(result.tolerance), result.note);
        failed += !result.Passed();
    }
    return failed;
}

void WriteHeavyTails(const std::string& folder, const std::string& model, uint64_t seed) {
    std::vector<std::string> rules = UsualRules();
    for (const char* loose : {"dammertz:0.1", "cycles:0.1", "luxtile:0.1", "lnoise:2", "entropy:2"})
        rules.push_back(loose);
    rules.push_back("learned:" + model);
    std::ofstream out(folder + "/heavy_tails.csv");
    out << "samples,rule,stops at spp,bias in %,error in %,unseen in %\n";
    for (const Tail& tail : HeavyTails()) {
        const std::vector<StopOutcome> outcomes = StopBlocks(tail, rules, seed);
        for (size_t i = 0; i < rules.size(); ++i)
            out << fmt::format(
                "\"{}\",{},{},{:.2f},{:.1f},{}\n", tail.name,
                rules[i].starts_with("learned") ? "learned" : rules[i], outcomes[i].spp,
                100 * outcomes[i].bias, 100 * outcomes[i].error,
                tail.rarity > 0 ? fmt::format("{:.1f}", 100 * outcomes[i].unseen) : "");
    }
}

int WriteTables(const std::string& model, const std::string& folder) {
    const HardCaseOptions options;
    const int failed = WriteCases(folder, options);
    WriteHeavyTails(folder, model, options.seed);
    fmt::print("{} failed; seed {}\n", failed, options.seed);
    return failed > 0;
}

}  // namespace
}  // namespace lull

int main(int count, char** arguments) {
    if (count == 3) return lull::WriteTables(arguments[1], arguments[2]);
    fmt::print(stderr, "usage: hard_cases_tables MODEL.h5 FOLDER\n");
    return 1;
}
