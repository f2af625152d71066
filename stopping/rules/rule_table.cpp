#include "stopping/rules/rule_table.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <stdexcept>
#include <vector>

#include "stopping/base/input_file.h"
#include "stopping/rules/baselines.h"
#include "stopping/rules/learned.h"
#include "stopping/rules/thresholds.h"

namespace lull {

namespace {

// In the order of RuleEntry.
constexpr RuleEntry kRules[] = {
    {"learned", "[:NAME|:MODEL.h5]", nullptr,
     "when a network finds no visible noise at three consecutive checks", RuleTrend::Probability,
     true, ReadLearned},
    {"entropy", "[:T]", "0.64",
     "when its visible noise, measured by the drop in SVD-entropy from n/2 to n spp, is "
     "below T@ at three consecutive checks",
     RuleTrend::Error, true, ReadEntropy},
    {"dammertz", "[:T[:area]]", "0.02", "when its mean error in square-root brightness is below T@",
     RuleTrend::Error, false, ReadDammertz},
    {"cycles", ":T", nullptr, "when no pixel has an error of T or more, as in Blender's Cycles",
     RuleTrend::Error, false, ReadCycles},
    {"luxtile", ":T", nullptr, "when its largest display error is below T, as in LuxCore",
     RuleTrend::Error, false, ReadLuxTile},
    {kLightnessNoiseName, "[:T]", "0.65",
     "when its noise in L*, masked by texture, is below T@ at three consecutive checks",
     RuleTrend::Error, true, ReadLightnessNoise},
    {kDenoisedRuleName, "[:T]", "3.1",
     "when the estimated visible difference between the denoised block and the true one "
     "is below T@; the default with --denoise",
     RuleTrend::Error, true, ReadDenoised},
    {"thresholds", ":FILE[:NAME]", nullptr, "at the spp that a row of a thresholds file has for it",
     RuleTrend::Samples, false, ReadThresholdsRule},
    {"fixed", ":N", nullptr, "at N spp", RuleTrend::Samples, false, ReadFixed}};

std::string Joined(const std::vector<std::string>& texts) {
    std::string joined;
    for (size_t i = 0; i < texts.size(); ++i)
        joined.append(i == 0 ? "" : i + 1 == texts.size() ? " and " : ", ").append(texts[i]);
    return joined;
}

bool TakesCaution(const RuleEntry& rule) { return rule.takesCaution; }

void CheckCaution(const RuleEntry& rule, double caution) {
    if (!(caution > 0) || !std::isfinite(caution))
        throw std::invalid_argument("caution must be above 0");
    if (caution != 1 && !rule.takesCaution)
        throw std::invalid_argument(
            "caution scales visible noise, which this rule does not measure; others do: " +
            RuleNames(TakesCaution));
}

std::string FormOf(const RuleEntry& rule) { return std::string(rule.name).append(rule.argument); }

// Appends the words of a text, in lines of at most `width` that begin with `indent` spaces. The
// first of them goes on where `to` ends.
void AppendWrapped(const std::string& text, size_t indent, size_t width, std::string* to) {
    size_t column = indent;
    for (size_t begin = 0; begin < text.size();) {
        const size_t end = std::min(text.find(' ', begin), text.size());
        if (column > indent && column + 1 + (end - begin) > width) {
            to->append("\n").append(indent, ' ');
            column = indent;
        } else if (column > indent) {
            to->append(" ");
            ++column;
        }
        to->append(text, begin, end - begin);
        column += end - begin;
        begin = end + 1;
    }
}

}  // namespace

std::span<const RuleEntry> RuleTable() { return kRules; }

Rule ParseRule(const std::string& given, const RuleContext& context) {
    const RuleEntry* entry = FindRule(given);
    const bool isComplete = !entry || !entry->standard || given.find(':') != std::string::npos;
    const std::string text = isComplete ? given : given + ":" + entry->standard;
    try {
        if (!entry) throw std::invalid_argument("there is no such rule; there are " + RuleForms());
        CheckCaution(*entry, context.caution);
        Rule rule = entry->read(ArgumentOf(given), context);
        rule.text = text;
        if (rule.peak.most > 0 && context.hasHalves)
            rule.need = std::max(rule.need, ViewNeed::MeanAndHalf);
        rule.trend.kind = entry->compares;
        rule.trend.votes = std::max(1, rule.votes);
        if (context.caution != 1) {
            char number[32];
            const auto end = std::to_chars(number, number + sizeof(number), context.caution).ptr;
            rule.text.append(", caution ").append(number, end);
        }
        return rule;
    } catch (const std::invalid_argument& error) {
        throw std::invalid_argument("stopping rule '" + Printable(text) + "': " + error.what());
    }
}

const RuleEntry* FindRule(std::string_view text) {
    const auto rule = std::ranges::find(
        kRules, text.substr(0, std::min(text.find(':'), text.size())), &RuleEntry::name);
    return rule == std::end(kRules) ? nullptr : rule;
}

std::string ArgumentOf(std::string_view text) {
    const size_t colon = text.find(':');
    if (colon != std::string_view::npos) return std::string(text.substr(colon + 1));
    const RuleEntry* rule = FindRule(text);
    return rule && rule->standard ? rule->standard : "";
}

std::string WhenItStops(const RuleEntry& rule) {
    std::string text(rule.stops);
    const size_t at = text.find('@');
    if (at != std::string::npos) text.replace(at, 1, std::string(" (") + rule.standard + ")");
    return text;
}

std::string RuleForms() {
    std::vector<std::string> forms;
    for (const RuleEntry& rule : kRules) forms.push_back(FormOf(rule));
    return Joined(forms);
}

std::string RuleNames(bool (*which)(const RuleEntry&)) {
    std::vector<std::string> names;
    for (const RuleEntry& rule : kRules)
        if (which(rule)) names.emplace_back(rule.name);
    return Joined(names);
}

std::string RuleHelp(size_t width) {
    size_t indent = 0;
    for (const RuleEntry& rule : kRules) indent = std::max(indent, FormOf(rule).size() + 4);
    std::string help;
    for (const RuleEntry& rule : kRules) {
        const std::string form = "  " + FormOf(rule);
        help.append(form).append(indent - form.size(), ' ');
        AppendWrapped(WhenItStops(rule), indent, width, &help);
        help += "\n";
    }
    return help;
}

}  // namespace lull
