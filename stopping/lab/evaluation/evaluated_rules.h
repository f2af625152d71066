// Judges rules, and thresholds from files, where people have judged.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "stopping/lab/evaluation/evaluation.h"
#include "stopping/lab/evaluation/simulation.h"
#include "stopping/lab/recordings/labelled_blocks.h"
#include "stopping/lab/recordings/recording.h"
#include "stopping/rules/rule.h"

namespace lull {

// Lists how stopping rules (rules/rule_table.h) run on recordings, and their compared thresholds.

// Contents of a recording that a rule needs.
enum class Replay {
    Decides,   // its measurements, from which it decides again
    Counts,    // none: it only counts samples
    RanAlong,  // its stops at kCyclesThresholds
    Unknown    // not recorded
};

struct RecordedRule {
    std::string_view name;  // as in RuleTable()
    Replay replay;
    // Of a rule that decides: the channel of its number, by root mean square; null: Rule::inputs.
    const char* channel = nullptr;
    // Thresholds of curves, from where it stops at once to where it hardly ever does; empty: none.
    std::span<const double> curve = {};
    // For the choice of the best: all between them in steps of 1 %, or those it RanAlong. 0: none.
    double largest = 0, least = 0;
};

// Returns an entry for each rule of RuleTable(), in that order.
std::span<const RecordedRule> RecordedRules();

// Returns the entry of a text NAME[:ARGUMENT]; null if there is no such rule.
const RecordedRule* FindRecordedRule(std::string_view text);

// Returns whether record after record has what a rule measures.
bool HasRecordedSignals(const Rule& rule);

// Returns what such a rule measures, from record i. Throws std::invalid_argument for features that
// were not recorded.
Signals RecordedSignals(const Rule& rule, const BlockRecording& recording, int i);

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

// The best setting of a rule has the least mean error of the thresholds, or critical error at 2 %.
enum class ChooseBy { AbsoluteError, CriticalError };

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

// Gives each simple rule the best chance: its setting is chosen on other viewpoints.

// Returns that error, in spp or a share in [0, 1]. `grid` is the step of critical errors, in spp.
double CostOf(const ViewpointOutcome& viewpoint, ChooseBy, int grid);

// Runs the rules over recorded blocks (grouped by viewpoint), each viewpoint with the setting that
// does best on the others; of equally good ones the one that takes the fewest samples. A rule has
// the best setting on all viewpoints, for use on new ones: a threshold, to three digits. Thresholds
// are RecordedRule's. Rules that compare halves are left out where a block was recorded without
// (HasHalves()). Throws std::invalid_argument for fewer than two.
std::vector<EvaluatedRule> EvaluateRivals(std::span<const LabelledBlock> blocks, ChooseBy chooseBy,
                                          int grid);

// One sample count for all blocks of an image: the baseline of rules that measure blocks.

// Returns up to three rules, of which every block of a viewpoint stops at one multiple of 20 spp
// (their setting): "constant, known", the best one on this viewpoint itself, which no rule can
// know; with two viewpoints or more "constant, of others", the best one on the others; and
// "constant", the best one on all. Only names and human thresholds are read of the outcomes. `grid`
// is the step of critical errors, in spp. Throws std::invalid_argument if there is no viewpoint.
std::vector<EvaluatedRule> EvaluateConstants(std::span<const ViewpointOutcome> viewpoints, ChooseBy,
                                             int grid);

}  // namespace lull
