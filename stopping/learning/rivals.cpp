#include "stopping/learning/rivals.h"

#include <algorithm>
#include <charconv>
#include <functional>
#include <stdexcept>

namespace lull {

namespace {

// Names a rule that has one setting, with the range in which it can be of use: beyond it, every
// block stops at once or never.
struct RivalRule {
    const char* name;
    ErrorRule error;
    double largest, least;
};
constexpr RivalRule kErrorRules[] = {{"dammertz", ErrorRule::Dammertz, 1, 1e-4},
                                     {"luxtile", ErrorRule::LuxTile, 1, 1e-4},
                                     {"lnoise", ErrorRule::LNoise, 50, 0.01},
                                     {"entropy", ErrorRule::Entropy, 50, 0.01}};

std::vector<double> SettingsOf(const RivalRule& rule) {
    std::vector<double> settings;
    for (double t = rule.largest; t >= rule.least; t /= 1.01) settings.push_back(t);
    return settings;
}

std::string Text(double setting) {
    char text[32];
    const auto end =
        std::to_chars(text, text + sizeof(text), setting, std::chars_format::general, 3).ptr;
    return std::string(text, end);
}

// Runs a setting over block number `index`; without verdicts if `brief`.
using Run = std::function<RuleOutcome(size_t index, double setting, bool brief)>;

double Cost(const ViewpointOutcome& viewpoint, ChooseBy chooseBy, int grid) {
    const bool critical = chooseBy == ChooseBy::CriticalError;
    const Judgement judgement =
        Judge(std::span(&viewpoint, 1),
              {.grid = grid, .margins = critical ? std::vector<double>{2} : std::vector<double>()});
    return critical ? judgement.criticalErrors[0] : judgement.absoluteError;
}

// Returns costs[viewpoint][setting]. `begins` says where viewpoints begin in the blocks.
std::vector<std::vector<double>> Costs(std::span<const JudgedBlock> blocks,
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
            row.push_back(Cost(viewpoint, chooseBy, grid));
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

Rival JudgeRival(const std::string& name, std::span<const JudgedBlock> blocks,
                 std::span<const size_t> begins, std::span<const double> settings, const Run& run,
                 ChooseBy chooseBy, int grid) {
    const auto costs = Costs(blocks, begins, settings, run, chooseBy, grid);
    Rival rival{.rule = name, .viewpoints = {}, .bestOfAll = Best(costs, settings, -1)};
    for (size_t v = 0; v + 1 < begins.size(); ++v) {
        const double setting = Best(costs, settings, int(v));
        ViewpointOutcome& viewpoint = rival.viewpoints.emplace_back(
            ViewpointOutcome{.name = blocks[begins[v]].viewpoint, .setting = Text(setting)});
        for (size_t i = begins[v]; i < begins[v + 1]; ++i)
            viewpoint.blocks.push_back(
                {.human = blocks[i].human, .outcome = run(i, setting, false)});
    }
    return rival;
}

Run MakeRun(std::span<const JudgedBlock> blocks, ErrorRule rule) {
    std::vector<ErrorSeries> series;
    for (const JudgedBlock& block : blocks)
        series.push_back(MakeErrorSeries(*block.recording, rule));
    return [=](size_t index, double setting, bool brief) {
        return SimulateErrorRule(blocks[index], series[index], setting, brief);
    };
}

}  // namespace

std::vector<Rival> JudgeRivals(std::span<const JudgedBlock> blocks, ChooseBy chooseBy, int grid) {
    std::vector<size_t> begins;
    for (size_t i = 0; i < blocks.size(); ++i)
        if (i == 0 || blocks[i].viewpoint != blocks[i - 1].viewpoint) begins.push_back(i);
    if (begins.size() < 2)
        throw std::invalid_argument("settings are chosen on other viewpoints, so two are needed");
    begins.push_back(blocks.size());

    std::vector<Rival> rivals;
    for (const RivalRule& rule : kErrorRules)
        rivals.push_back(JudgeRival(rule.name, blocks, begins, SettingsOf(rule),
                                    MakeRun(blocks, rule.error), chooseBy, grid));
    const Run cycles = [&](size_t index, double setting, bool brief) {
        return SimulateCycles(blocks[index], setting, brief);
    };
    rivals.push_back(
        JudgeRival("cycles", blocks, begins, kCyclesThresholds, cycles, chooseBy, grid));
    return rivals;
}

}  // namespace lull
