#include "stopping/lab/evaluation/rivals.h"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <stdexcept>

#include "stopping/lab/evaluation/evaluated_rules.h"
#include "stopping/rules/rule_table.h"

namespace lull {

namespace {

// Returns the rules with one threshold that can be run on the recorded data of the blocks.
std::vector<const RecordedRule*> RivalRules(std::span<const LabelledBlock> blocks) {
    const bool haveHalves = std::ranges::all_of(
        blocks, [](const LabelledBlock& block) { return HasHalves(*block.recording); });
    std::vector<const RecordedRule*> rivals;
    for (const RecordedRule& rule : RecordedRules()) {
        if (rule.largest == 0) continue;
        const bool comparesHalves =
            rule.replay == Replay::RanAlong ||
            ParseRule(std::string(rule.name) + ":1", {.hasHalves = false}).need >=
                ViewNeed::MeanAndHalf;
        if (comparesHalves && !haveHalves) continue;
        rivals.push_back(&rule);
    }
    return rivals;
}

std::string TextOf(double setting) { return fmt::format("{:.3g}", setting); }

std::vector<double> SettingsOf(const RecordedRule& rule) {
    if (rule.replay == Replay::RanAlong)
        return {kCyclesThresholds.begin(), kCyclesThresholds.end()};
    std::vector<double> settings;
    for (double t = rule.largest; t >= rule.least; t /= 1.01) settings.push_back(t);
    return settings;
}

// Runs a setting over block number `index`; without verdicts if `brief`.
using Run = std::function<RuleOutcome(size_t index, double setting, bool brief)>;

// Returns costs[viewpoint][setting]. `begins` says where viewpoints begin in the blocks.
std::vector<std::vector<double>> Costs(std::span<const LabelledBlock> blocks,
                                       std::span<const size_t> begins,
                                       std::span<const double> settings, const Run& run,
                                       ChooseBy chooseBy, int grid) {
    std::vector<std::vector<double>> costs;
    for (size_t v = 0; v + 1 < begins.size(); ++v) {
        std::vector<double>& row = costs.emplace_back();
        for (const double setting : settings) {
            ViewpointOutcome viewpoint{.name = blocks[begins[v]].viewpoint};
            for (size_t i = begins[v]; i < begins[v + 1]; ++i)
                viewpoint.blocks.push_back(
                    {.human = blocks[i].human, .outcome = run(i, setting, true)});
            row.push_back(CostOf(viewpoint, chooseBy, grid));
        }
    }
    return costs;
}

// Returns the setting of the least mean cost over all viewpoints but `left` (-1: none is left out),
// the first among equals.
double Best(const std::vector<std::vector<double>>& costs, std::span<const double> settings,
            int left) {
    std::vector<double> sums(settings.size(), 0);
    for (size_t v = 0; v < costs.size(); ++v)
        for (size_t s = 0; s < settings.size(); ++s)
            if (int(v) != left) sums[s] += costs[v][s];
    return settings[size_t(std::ranges::min_element(sums) - sums.begin())];
}

EvaluatedRule EvaluateRival(const std::string& name, std::span<const LabelledBlock> blocks,
                            std::span<const size_t> begins, std::span<const double> settings,
                            const Run& run, ChooseBy chooseBy, int grid) {
    const auto costs = Costs(blocks, begins, settings, run, chooseBy, grid);
    EvaluatedRule rival{.name = name, .setting = TextOf(Best(costs, settings, -1))};
    for (size_t v = 0; v + 1 < begins.size(); ++v) {
        const double setting = Best(costs, settings, int(v));
        ViewpointOutcome& viewpoint = rival.viewpoints.emplace_back(
            ViewpointOutcome{.name = blocks[begins[v]].viewpoint, .setting = TextOf(setting)});
        for (size_t i = begins[v]; i < begins[v + 1]; ++i)
            viewpoint.blocks.push_back({.human = blocks[i].human,
                                        .outcome = run(i, setting, false),
                                        .block = blocks[i].block});
    }
    return rival;
}

// Runs a rule over recordings, each of which it reads once.
Run MakeRun(std::span<const LabelledBlock> blocks, const RecordedRule& entry) {
    if (entry.replay == Replay::RanAlong)
        return [=](size_t index, double setting, bool brief) {
            return SimulateCycles(blocks[index], setting, brief);
        };
    const Rule rule =
        ParseRule(std::string(entry.name) + ":1", {.passSpp = blocks.front().passSpp});
    std::vector<ErrorSeries> series;
    for (const LabelledBlock& block : blocks) series.push_back(MakeErrorSeries(block, rule));
    return [=](size_t index, double setting, bool brief) {
        return SimulateErrorRule(blocks[index], series[index], setting, brief);
    };
}

}  // namespace

double CostOf(const ViewpointOutcome& viewpoint, ChooseBy chooseBy, int grid) {
    if (chooseBy == ChooseBy::CriticalError) return CriticalError(viewpoint.blocks, 2, grid);
    return Score(std::span(&viewpoint, 1), {.grid = grid, .margins = {}}).absoluteError;
}

std::vector<EvaluatedRule> EvaluateRivals(std::span<const LabelledBlock> blocks, ChooseBy chooseBy,
                                          int grid) {
    std::vector<size_t> begins;
    for (size_t i = 0; i < blocks.size(); ++i)
        if (i == 0 || blocks[i].viewpoint != blocks[i - 1].viewpoint) begins.push_back(i);
    if (begins.size() < 2)
        throw std::invalid_argument(
            "the settings of baselines are chosen on other viewpoints, so that two are needed; "
            "--stop takes rules with settings");
    begins.push_back(blocks.size());

    std::vector<EvaluatedRule> rivals;
    for (const RecordedRule* rule : RivalRules(blocks))
        rivals.push_back(EvaluateRival(std::string(rule->name), blocks, begins, SettingsOf(*rule),
                                       MakeRun(blocks, *rule), chooseBy, grid));
    return rivals;
}

namespace {

constexpr int kStep = 20;  // spp between constants

int SppOf(size_t constant) { return kStep * int(constant + 1); }

// Returns the viewpoint as it is where all of its blocks stop at one spp; without verdicts if
// `brief`.
ViewpointOutcome StoppedAt(const ViewpointOutcome& viewpoint, int spp, int grid, bool brief) {
    ViewpointOutcome result{.name = viewpoint.name, .setting = fmt::format("{}", spp)};
    for (const BlockOutcome& block : viewpoint.blocks)
        result.blocks.push_back(
            {.human = block.human,
             .outcome = brief ? RuleOutcome{.stop = spp} : OutcomeOfStop(spp, grid),
             .block = block.block});
    return result;
}

std::vector<double> CostsOf(const ViewpointOutcome& viewpoint, ChooseBy chooseBy, int grid) {
    std::vector<double> costs;
    for (size_t i = 0; SppOf(i) <= kMostShownSpp; ++i)
        costs.push_back(CostOf(StoppedAt(viewpoint, SppOf(i), grid, true), chooseBy, grid));
    return costs;
}

// Returns the spp of the least sum of costs, the first among equals.
int BestOf(const std::vector<double>& costs) {
    return SppOf(size_t(std::ranges::min_element(costs) - costs.begin()));
}

}  // namespace

std::vector<EvaluatedRule> EvaluateConstants(std::span<const ViewpointOutcome> viewpoints,
                                             ChooseBy chooseBy, int grid) {
    if (viewpoints.empty()) throw std::invalid_argument("constants: there is no viewpoint");
    std::vector<std::vector<double>> costs;
    std::vector<double> all(kMostShownSpp / kStep, 0);
    for (const ViewpointOutcome& viewpoint : viewpoints) {
        costs.push_back(CostsOf(viewpoint, chooseBy, grid));
        for (size_t i = 0; i < all.size(); ++i) all[i] += costs.back()[i];
    }
    EvaluatedRule known{.name = "constant, known"}, others{.name = "constant, of others"},
        one{.name = "constant", .setting = fmt::format("{}", BestOf(all))};
    for (size_t v = 0; v < viewpoints.size(); ++v) {
        std::vector<double> rest = all;
        for (size_t i = 0; i < rest.size(); ++i) rest[i] -= costs[v][i];
        const auto add = [&](int spp, EvaluatedRule* rule) {
            rule->viewpoints.push_back(StoppedAt(viewpoints[v], spp, grid, false));
        };
        add(BestOf(costs[v]), &known);
        add(BestOf(rest), &others);
        add(BestOf(all), &one);
    }
    if (viewpoints.size() < 2) return {known, one};
    return {known, others, one};
}

}  // namespace lull
