// Simulates stopping rules on recorded blocks, without rendering them again.
//
// Recordings hold all passes up to 400 spp and every second one after, and a rule is simulated as
// if there were no others: it votes on recorded passes. Verdicts (evaluation.h) are given at every
// second pass, which recordings have from the first to the last; a pass that the rule does not
// check is a verdict of noise, as the rule continues. Where records come at any spp (pictures,
// passSpp 0), a rule checks them as it does pictures (Checks::any), and verdicts are at all of
// them.
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "stopping/lab/evaluation/evaluation.h"
#include "stopping/lab/recordings/labelled_blocks.h"
#include "stopping/rules/rule.h"

namespace lull {

// Returns the decisions of a rule after every recorded pass, also once it has stopped the block;
// `noise`, unless it is null, gets Criterion::NetworkNoise() after each. Throws as SimulateRule().
std::vector<Decision> ReplayRule(const LabelledBlock& block, const Rule& rule,
                                 std::vector<std::optional<double>>* noise = nullptr);

// The numbers that a rule compares with its threshold, for sweeps of that.
struct ErrorSeries {
    std::vector<double> errors = {};  // of each record; infinite where there is none
    int needed = 1;                   // errors below the threshold in a row that stop the block
};
ErrorSeries MakeErrorSeries(const LabelledBlock& block, const Rule& rule);

// Returns the record at which a threshold stops the block; -1: none.
int FirstBelow(const ErrorSeries& series, double threshold);

// Each returns the outcome of a rule on a block. Recordings that are empty throw
// std::invalid_argument, and so does a threshold of cycles that is none of kCyclesThresholds, and a
// model that does not fit the passes, needs unrecorded features or checks no record. Without
// verdicts if `brief`.
RuleOutcome SimulateErrorRule(const LabelledBlock& block, const ErrorSeries& series,
                              double threshold, bool brief = false);
RuleOutcome SimulateCycles(const LabelledBlock& block, double threshold, bool brief = false);
// Decides as in a render, on signals that were recorded (HasRecordedSignals()), with a rule that
// was made for the block's passes.
RuleOutcome SimulateRule(const LabelledBlock& block, const Rule& rule);
// Stops at `spp`, wherever the recording ends.
RuleOutcome SimulateStop(const LabelledBlock& block, int spp);

// Returns a block's threshold in the rows of the file `path`. Throws std::runtime_error if none.
int ThresholdIn(std::span<const ThresholdsRow> rows, const std::string& path,
                const LabelledBlock& block);

// Returns the outcome of a rule on a block; can be called from several threads.
using Simulator = std::function<RuleOutcome(const LabelledBlock& block)>;

// Reads a rule as ParseRule() does, with the files it names and for the passes of the
// recordings; but `thresholds:FILE` takes the rows that have the viewpoints' names. Throws
// std::invalid_argument and std::runtime_error as that does, and for a rule that cannot be run on
// recordings; the simulator throws std::runtime_error for a block that a file does not have.
Simulator MakeSimulator(const std::string& rule, const RuleContext& context = {});

// Runs a rule over blocks, on all cores; the blocks of one viewpoint follow each other.
std::vector<ViewpointOutcome> Simulate(std::span<const LabelledBlock> blocks,
                                       const Simulator& rule);

// Judges rules on recordings that end too early: once at least, and once extended.

// Adds the outcome of a rule on `blocks`, whose recordings are unextended. Where it had not stopped
// all of them it is added twice, so that no figure looks final: stopped at their ends, and then the
// result of `extend`, its outcome on the same blocks with extended recordings. `extend` can be
// empty if no recording ends below kMostShownSpp.
void AddTwoFigures(std::span<const LabelledBlock> blocks, EvaluatedRule recorded,
                   const std::function<EvaluatedRule()>& extend, std::vector<EvaluatedRule>* rules);

}  // namespace lull
