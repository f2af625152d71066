// Judges rules, and thresholds from files, where people have judged.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "stopping/lab/evaluation/rivals.h"
#include "stopping/lab/recordings/labelled_blocks.h"

namespace lull {

// Reads people's thresholds less the viewpoints in `without`. Throws std::runtime_error, also for
// a name in `without` that there is not.
std::vector<ThresholdsRow> ReadHumanThresholds(const std::string& human,
                                               const std::vector<std::string>& without);

// Judges the thresholds of a file on the viewpoints that people judged, too, every `grid` spp;
// `human` is the name of the file that has people's. Tells how many viewpoints they did not judge.
// Throws std::runtime_error if both have no viewpoint in common, or not the same blocks.
EvaluatedRule EvaluateThresholds(const std::string& path, const std::string& human,
                                 const std::vector<ThresholdsRow>& people, int grid,
                                 const WarningSink& warn);

// Which rules are judged on recorded blocks.
struct RulesToEvaluate {
    bool rivals = false;  // the rules that have one setting, see EvaluateRivals()
    ChooseBy chooseBy = ChooseBy::AbsoluteError;
    std::vector<std::string> rules = {};  // as MakeSimulator() reads them
    RuleContext context = {};
    // Files of thresholds: taken as they are, and, where recordings end below the cap, clipped to
    // that end as well, as rules that run on recordings are.
    std::vector<std::string> predicted = {};
    int grid = 40;  // spp between the allScores of rivals
};

// Judges rivals, rules and files, in this order; rules that had not stopped all blocks where their
// recordings end come twice, see AddTwoFigures(). Throws as MakeSimulator() and its simulators do,
// and std::runtime_error for a block that a file does not have.
std::vector<EvaluatedRule> EvaluateOnBlocks(std::span<const LabelledBlock> blocks,
                                            const RulesToEvaluate&);

}  // namespace lull
