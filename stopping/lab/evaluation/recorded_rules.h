// Lists how stopping rules (rules/rule_table.h) run on recordings, and at which thresholds they are
// compared.
#pragma once

#include <span>
#include <string_view>

#include "stopping/lab/recordings/recording.h"
#include "stopping/rules/rule.h"

namespace lull {

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
    // Of a rule that decides: the channel of its number, the root mean square of its values; null:
    // its inputs (Rule::inputs).
    const char* channel = nullptr;
    // Thresholds of curves, from where it stops at once to where it hardly ever does; empty: none.
    std::span<const double> curve = {};
    // For the choice of the best one: all between them in steps of 1 %, or those at which it
    // RanAlong. Both 0: none is chosen.
    double largest = 0, least = 0;
};

// Returns an entry for each rule of RuleTable(), in that order.
std::span<const RecordedRule> RecordedRules();

// Returns the entry of a text NAME[:ARGUMENT]; null if there is no such rule.
const RecordedRule* FindRecordedRule(std::string_view text);

// Returns whether record after record has what a rule measures, which ParseRule() or LearnedRule()
// has made.
bool HasRecordedSignals(const Rule& rule);

// Returns what such a rule measures, from record i. Throws std::invalid_argument for features that
// were not recorded.
Signals RecordedSignals(const Rule& rule, const BlockRecording& recording, int i);

}  // namespace lull
