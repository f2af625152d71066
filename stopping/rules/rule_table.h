// Lists the stopping rules: their names, what they say of themselves, how they are made and run on
// recordings. Help, benchmarks, rivals and documents have them from here.
#pragma once

#include <span>
#include <string>
#include <string_view>

#include "stopping/rules/criterion.h"

namespace lull {

// Says what a recording knows of a rule.
enum class Replay {
    Decides,   // what it measures, so that it decides again (VotingRule::recall)
    Counts,    // nothing is needed: it stops where it says
    RanAlong,  // where it stopped at kCyclesThresholds
    Unknown    // nothing
};

// Says with which settings a rule is compared with others.
struct RuleSweep {
    // For benchmarks, from where it stops at once to where it hardly ever does; empty: none.
    std::span<const double> bench = {};
    // For the choice of the best one: all between them in steps of 1 %, or those at which it
    // RanAlong. Both 0: none is chosen.
    double largest = 0, least = 0;
    bool choosesMask = false;  // and once more with that of NoiseVisibility::mask
};

struct Rule {
    std::string_view name;
    std::string_view argument;  // what follows the name, as help has it
    const char* standard;       // the argument where none is given; null: the rule says
    // Ends "a block stops"; '@' stands for the argument where none is given.
    std::string_view stops;
    ViewNeed need;             // the most that it looks at
    RuleTrend::Kind compares;  // what its number is
    int votes;                 // in a row that stop a block; 0: one number does
    bool takesCaution;         // whether its threshold is one of visible noise
    Replay replay;
    RuleSweep sweep;
    // Returns all but the rule's text and kind. Throws as MakeCriterionFactory() does.
    CriterionFactory (*make)(const std::string& argument, const RuleContext& context);
};

std::span<const Rule> AllRules();

// Returns the rule that a text NAME[:ARGUMENT] is of; null if there is no such rule.
const Rule* FindRule(std::string_view text);

// Returns the argument of the text of a rule, or what stands for it where none is given.
std::string ArgumentOf(std::string_view text);

// Returns when a block stops, in words.
std::string WhenItStops(const Rule& rule);

// Returns "fixed:N, dammertz[:T[:area]], ... and luxtile:T".
std::string RuleForms();
// Returns the names of the rules that `which` chooses: "a, b and c".
std::string RuleNames(bool (*which)(const Rule&));

// Returns a line or more for each rule, `width` wide at the most.
std::string RuleHelp(size_t width);

}  // namespace lull
