#include "stopping/learning/rivals.h"

#include <algorithm>
#include <charconv>
#include <functional>
#include <stdexcept>

namespace lull {

namespace {

// Names a rule that has one threshold, with the range in which it can be of use: beyond it, every
// block stops at once or never. Where there are `masks`, one of them is chosen as well.
struct RivalRule {
    const char* name;
    ErrorRule error;
    double largest, least;
    std::span<const double> masks = {};
};

// What NoiseVisibility::mask may be, the default first; the last hides nothing.
constexpr double kMasks[] = {40, 8, 12, 16, 24, 1e9};

constexpr RivalRule kErrorRules[] = {{"dammertz", ErrorRule::Dammertz, 1, 1e-4},
                                     {"luxtile", ErrorRule::LuxTile, 1, 1e-4},
                                     {"lnoise", ErrorRule::LNoise, 50, 0.01},
                                     {"entropy", ErrorRule::Entropy, 50, 0.01},
                                     {"entropy, mask", ErrorRule::Entropy, 50, 0.01, kMasks}};

// Says with what a rule is run; `mask` counts in kMasks, -1 where there is none to choose.
struct Setting {
    double threshold = 0;
    int mask = -1;
};

std::vector<Setting> SettingsOf(const RivalRule& rule) {
    std::vector<Setting> settings;
    const int masks = int(rule.masks.size());
    for (int mask = masks > 0 ? 0 : -1; mask < masks; ++mask)
        for (double t = rule.largest; t >= rule.least; t /= 1.01) settings.push_back({t, mask});
    return settings;
}

std::string Text(double number) {
    char text[32];
    const auto end =
        std::to_chars(text, text + sizeof(text), number, std::chars_format::general, 3).ptr;
    return std::string(text, end);
}

std::string Text(const Setting& setting) {
    if (setting.mask < 0) return Text(setting.threshold);
    return Text(setting.threshold) + ", " + Text(kMasks[setting.mask]);
}

// Runs a setting over block number `index`; without verdicts if `brief`.
using Run = std::function<RuleOutcome(size_t index, const Setting& setting, bool brief)>;

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
                                       std::span<const Setting> settings, const Run& run,
                                       ChooseBy chooseBy, int grid) {
    std::vector<std::vector<double>> costs;
    for (size_t v = 0; v + 1 < begins.size(); ++v) {
        std::vector<double>& row = costs.emplace_back();
        for (const Setting& setting : settings) {
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
Setting Best(const std::vector<std::vector<double>>& costs, std::span<const Setting> settings,
             int left) {
    std::vector<double> sums(settings.size(), 0);
    for (size_t v = 0; v < costs.size(); ++v)
        for (size_t s = 0; s < settings.size(); ++s)
            if (int(v) != left) sums[s] += costs[v][s];
    return settings[size_t(std::ranges::min_element(sums) - sums.begin())];
}

Rival JudgeRival(const std::string& name, std::span<const JudgedBlock> blocks,
                 std::span<const size_t> begins, std::span<const Setting> settings, const Run& run,
                 ChooseBy chooseBy, int grid) {
    const auto costs = Costs(blocks, begins, settings, run, chooseBy, grid);
    Rival rival{.rule = name, .viewpoints = {}, .bestOfAll = Text(Best(costs, settings, -1))};
    for (size_t v = 0; v + 1 < begins.size(); ++v) {
        const Setting setting = Best(costs, settings, int(v));
        ViewpointOutcome& viewpoint = rival.viewpoints.emplace_back(
            ViewpointOutcome{.name = blocks[begins[v]].viewpoint, .setting = Text(setting)});
        for (size_t i = begins[v]; i < begins[v + 1]; ++i)
            viewpoint.blocks.push_back(
                {.human = blocks[i].human, .outcome = run(i, setting, false)});
    }
    return rival;
}

// Runs a rule over recordings, each of which it reads once for each mask.
Run MakeRun(std::span<const JudgedBlock> blocks, const RivalRule& rule) {
    std::vector<std::vector<ErrorSeries>> series;  // by mask, by block
    for (size_t m = 0; m < std::max<size_t>(rule.masks.size(), 1); ++m) {
        NoiseVisibility visibility;
        if (!rule.masks.empty()) visibility.mask = rule.masks[m];
        std::vector<ErrorSeries>& ofBlocks = series.emplace_back();
        for (const JudgedBlock& block : blocks)
            ofBlocks.push_back(MakeErrorSeries(*block.recording, rule.error, visibility));
    }
    return [=](size_t index, const Setting& setting, bool brief) {
        const std::vector<ErrorSeries>& ofBlocks = series[size_t(std::max(setting.mask, 0))];
        return SimulateErrorRule(blocks[index], ofBlocks[index], setting.threshold, brief);
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
                                    MakeRun(blocks, rule), chooseBy, grid));
    const Run cycles = [&](size_t index, const Setting& setting, bool brief) {
        return SimulateCycles(blocks[index], setting.threshold, brief);
    };
    std::vector<Setting> settings;
    for (const double threshold : kCyclesThresholds) settings.push_back({threshold});
    rivals.push_back(JudgeRival("cycles", blocks, begins, settings, cycles, chooseBy, grid));
    return rivals;
}

}  // namespace lull
