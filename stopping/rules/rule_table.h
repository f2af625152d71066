// Lists the stopping rules: names, descriptions and readers, also for help and documents.
#pragma once

#include <span>
#include <string>
#include <string_view>

#include "stopping/rules/rule.h"

namespace lull {

struct RuleEntry {
    std::string_view name;
    std::string_view argument;  // after the name, as in help
    const char* standard;       // the argument where none is given; null: the rule says
    // Ends "a block stops"; '@' stands for the argument where none is given.
    std::string_view stops;
    RuleTrend::Kind compares;  // kind of its number
    bool takesCaution;         // whether it measures visible noise, which caution scales
    // Returns all but the rule's text, and its trend's kind and votes. Throws as ParseRule().
    Rule (*read)(const std::string& argument, const RuleContext& context);
};

std::span<const RuleEntry> RuleTable();

inline constexpr const char* kDefaultRule = "learned";

// Reads a stopping rule, NAME[:ARGUMENT], and the files it names. Throws std::invalid_argument for
// a bad rule and std::runtime_error for a bad file; the message has fault and remedy.
Rule ParseRule(const std::string& text, const RuleContext& context = {});

// Returns the entry of a text NAME[:ARGUMENT]; null if there is no such rule.
const RuleEntry* FindRule(std::string_view text);

// Returns the argument in the text of a rule, or its default where none is given.
std::string ArgumentOf(std::string_view text);

// Returns when a block stops, in words.
std::string WhenItStops(const RuleEntry& rule);

// Returns "fixed:N, dammertz[:T[:area]], ... and luxtile:T".
std::string RuleForms();
// Returns the names of the rules that `which` chooses: "a, b and c".
std::string RuleNames(bool (*which)(const RuleEntry&));

// Returns a line or more for each rule, `width` wide at the most.
std::string RuleHelp(size_t width);

}  // namespace lull
