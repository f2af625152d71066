#include "stopping/rules/criterion.h"

#include <charconv>
#include <cmath>
#include <stdexcept>

#include "stopping/base/input_file.h"
#include "stopping/rules/rule_table.h"

namespace lull {

namespace {

bool TakesCaution(const Rule& rule) { return rule.takesCaution; }

void CheckCaution(const Rule& rule, double caution) {
    if (!(caution > 0) || !std::isfinite(caution))
        throw std::invalid_argument("caution must be above 0");
    if (caution != 1 && !rule.takesCaution)
        throw std::invalid_argument(
            "caution divides a threshold of visible noise, and this rule has none; " +
            RuleNames(TakesCaution) + " have one");
}

}  // namespace

void Criterion::Restore(std::span<const std::byte> state) {
    if (!state.empty())
        throw std::runtime_error("the saved state belongs to another stopping rule");
}

CriterionFactory MakeCriterionFactory(const std::string& given, const RuleContext& context) {
    const Rule* rule = FindRule(given);
    const bool isComplete = !rule || !rule->standard || given.find(':') != std::string::npos;
    const std::string text = isComplete ? given : given + ":" + rule->standard;
    try {
        if (!rule) throw std::invalid_argument("there is no such rule; there are " + RuleForms());
        CheckCaution(*rule, context.caution);
        CriterionFactory factory = rule->make(ArgumentOf(given), context);
        factory.rule = text;
        factory.trend.kind = rule->compares;
        if (context.caution != 1) {
            char number[32];
            const auto end = std::to_chars(number, number + sizeof(number), context.caution).ptr;
            factory.rule.append(", caution ").append(number, end);
        }
        return factory;
    } catch (const std::invalid_argument& error) {
        throw std::invalid_argument("stopping rule '" + Printable(text) + "': " + error.what());
    }
}

}  // namespace lull
