#include "stopping/lab/evaluation/evaluated_rules.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <functional>
#include <stdexcept>

#include "stopping/lab/evaluation/simulation.h"
#include "stopping/lab/recordings/extension.h"
#include "stopping/lab/recordings/labelled_blocks.h"
#include "stopping/rules/baselines.h"
#include "stopping/rules/learned.h"
#include "stopping/rules/rule_table.h"

namespace lull {

namespace {

constexpr double kNoiseLevels[] = {8, 4, 2, 1, 0.7, 0.5, 0.35, 0.25};
constexpr double kDammertzErrors[] = {0.32, 0.16, 0.08, 0.04, 0.02, 0.01, 0.005, 0.0025};
constexpr double kCyclesErrors[] = {0.64, 0.32, 0.16, 0.08, 0.04, 0.02, 0.01, 0.005};
constexpr double kLuxErrors[] = {0.5, 0.35, 0.25, 0.18, 0.12, 0.08, 0.04, 0.02};

// Name, replay, channel, curve, largest and least threshold.
constexpr RecordedRule kRules[] = {
    {"learned", Replay::Decides},
    {"entropy", Replay::Decides, nullptr, kNoiseLevels, 50, 0.01},
    {"dammertz", Replay::Decides, "dammertz", kDammertzErrors, 1, 1e-4},
    {"cycles", Replay::RanAlong, nullptr, kCyclesErrors, kCyclesThresholds.front(),
     kCyclesThresholds.back()},
    {"luxtile", Replay::Decides, "luxtile", kLuxErrors, 1, 1e-4},
    {kLightnessNoiseName, Replay::Decides, "masked_noise", kNoiseLevels, 50, 0.01},
    {kDenoisedRuleName, Replay::Unknown},
    {"thresholds", Replay::Counts},
    {"fixed", Replay::Counts}};

}  // namespace

std::span<const RecordedRule> RecordedRules() { return kRules; }

const RecordedRule* FindRecordedRule(std::string_view text) {
    const auto rule = std::ranges::find(
        kRules, text.substr(0, std::min(text.find(':'), text.size())), &RecordedRule::name);
    return rule == std::end(kRules) ? nullptr : rule;
}

bool HasRecordedSignals(const Rule& rule) {
    if (rule.inputs) return true;
    const RecordedRule* entry = FindRecordedRule(rule.text);
    // How large the image was, which that rule needs, recordings do not know.
    return entry && entry->channel && !rule.text.ends_with(":area");
}

Signals RecordedSignals(const Rule& rule, const BlockRecording& recording, int i) {
    if (rule.inputs) return MeasuresOf(recording, i, *rule.inputs);
    return PooledRms(recording.Values(i, FindRecordedRule(rule.text)->channel));
}

namespace {

// Adds rivals; settings of those that outlast recordings are chosen on extended ones as well.
void AddRivals(std::span<const LabelledBlock> blocks, std::span<const LabelledBlock> extended,
               const RulesToEvaluate& wanted, std::vector<EvaluatedRule>* rules) {
    const auto run = [&](std::span<const LabelledBlock> on) {
        return EvaluateRivals(on, wanted.chooseBy, wanted.grid);
    };
    std::vector<EvaluatedRule> recorded = run(blocks), longer;
    for (size_t i = 0; i < recorded.size(); ++i) {
        const auto extend = [&] {
            if (longer.empty()) longer = run(extended);
            return std::move(longer[i]);
        };
        AddTwoFigures(blocks, std::move(recorded[i]), extend, rules);
    }
}

std::string Stem(const std::string& path) { return std::filesystem::path(path).stem().string(); }

double ThresholdOf(const std::string& rule, const RuleContext& context) {
    const RecordedRule* entry = FindRecordedRule(rule);
    return entry && entry->replay == Replay::Decides ? ParseRule(rule, context).threshold : 0;
}

// Evaluates the thresholds of a file on recorded blocks; those beyond the end of a recording as
// they are or, if `clipped`, at that end.
EvaluatedRule EvaluateFile(const std::string& path, std::span<const LabelledBlock> blocks,
                           bool clipped) {
    const std::vector<ThresholdsRow> rows = ReadThresholds(path);
    const Simulator simulator = [&](const LabelledBlock& block) {
        RuleOutcome outcome = SimulateStop(block, ThresholdIn(rows, path, block));
        const int end = block.recording->spp.back();
        if (clipped && outcome.stop > end) {
            outcome.stop = end;
            outcome.open = true;
        }
        return outcome;
    };
    return {Stem(path) + (clipped ? ", clipped" : ""), "", Simulate(blocks, simulator)};
}

void MarkSeen(const std::map<std::string, std::vector<int>>& trainedOn, EvaluatedRule* rule) {
    for (ViewpointOutcome& viewpoint : rule->viewpoints) {
        const auto known = trainedOn.find(viewpoint.name);
        if (known == trainedOn.end()) continue;
        for (BlockOutcome& block : viewpoint.blocks)
            block.seen = std::ranges::find(known->second, block.block) != known->second.end();
    }
}

std::map<std::string, std::vector<int>> TrainingBlocksOf(const std::string& rule,
                                                         const RuleContext& context) {
    const RuleEntry* entry = FindRule(rule);
    if (!entry || entry->name != "learned") return {};
    return ReadTrainingBlocks(ModelPath(ArgumentOf(rule), context.models));
}

}  // namespace

std::vector<ThresholdsRow> ReadHumanThresholds(const std::string& human,
                                               const std::vector<std::string>& without) {
    std::vector<ThresholdsRow> rows = ReadThresholds(human);
    for (const std::string& name : without)
        if (std::erase_if(rows, [&](const ThresholdsRow& row) { return row.name == name; }) == 0)
            throw std::runtime_error(fmt::format("--without: {} has no row '{}'", human, name));
    return rows;
}

EvaluatedRule EvaluateThresholds(const std::string& path, const std::string& human,
                                 const std::vector<ThresholdsRow>& people, int grid,
                                 const WarningSink& warn) {
    const std::vector<ThresholdsRow> rows = ReadThresholds(path);
    EvaluatedRule rule{.name = Stem(path)};
    for (const ThresholdsRow& wanted : people) {
        const auto row = std::ranges::find(rows, wanted.name, &ThresholdsRow::name);
        if (row == rows.end()) continue;
        if (row->spp.size() != wanted.spp.size())
            throw std::runtime_error(fmt::format("{}: '{}' has {} thresholds, but {} in {}", path,
                                                 row->name, row->spp.size(), wanted.spp.size(),
                                                 human));
        ViewpointOutcome& viewpoint = rule.viewpoints.emplace_back();
        viewpoint.name = row->name;
        for (size_t i = 0; i < row->spp.size(); ++i)
            viewpoint.blocks.push_back({wanted.spp[i], OutcomeOfStop(row->spp[i], grid), int(i)});
    }
    if (rule.viewpoints.empty())
        throw std::runtime_error(fmt::format("{} and {} have no viewpoint in common", path, human));
    if (rule.viewpoints.size() < rows.size())
        warn(
            fmt::format("{} of {} viewpoints in {} are judged; there are no human thresholds for "
                        "the others",
                        rule.viewpoints.size(), rows.size(), path));
    return rule;
}

std::vector<EvaluatedRule> EvaluateOnBlocks(std::span<const LabelledBlock> blocks,
                                            const RulesToEvaluate& wanted) {
    std::vector<EvaluatedRule> rules;
    const ExtendedBlocks extended = ExtendBlocks(blocks);
    if (wanted.rivals) AddRivals(blocks, extended.blocks, wanted, &rules);
    RuleContext context = wanted.context;
    if (!blocks.empty()) context.passSpp = blocks.front().passSpp;
    for (const std::string& rule : wanted.rules) {
        const Simulator simulator = MakeSimulator(rule, context);
        const double threshold = ThresholdOf(rule, context);
        const auto trainedOn = TrainingBlocksOf(rule, context);
        const auto run = [&](std::span<const LabelledBlock> on) {
            EvaluatedRule made{
                .name = rule, .viewpoints = Simulate(on, simulator), .threshold = threshold};
            MarkSeen(trainedOn, &made);
            return made;
        };
        AddTwoFigures(
            blocks, run(blocks), [&] { return run(extended.blocks); }, &rules);
    }
    const bool anyShort = !extended.recordings.empty();
    for (const std::string& path : wanted.predicted) {
        rules.push_back(EvaluateFile(path, blocks, false));
        if (anyShort) rules.push_back(EvaluateFile(path, blocks, true));
    }
    return rules;
}

namespace {

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

ViewpointOutcome OutcomeOf(std::span<const LabelledBlock> blocks, std::span<const size_t> begins,
                           size_t v, double setting, const Run& run, bool brief) {
    ViewpointOutcome viewpoint{.name = blocks[begins[v]].viewpoint, .setting = TextOf(setting)};
    for (size_t i = begins[v]; i < begins[v + 1]; ++i)
        viewpoint.blocks.push_back({.human = blocks[i].human,
                                    .outcome = run(i, setting, brief),
                                    .block = blocks[i].block});
    return viewpoint;
}

std::vector<std::vector<double>> Costs(std::span<const LabelledBlock> blocks,
                                       std::span<const size_t> begins,
                                       std::span<const double> settings, const Run& run,
                                       ChooseBy chooseBy, int grid) {
    std::vector<std::vector<double>> costs;
    for (size_t v = 0; v + 1 < begins.size(); ++v) {
        std::vector<double>& row = costs.emplace_back();
        for (const double setting : settings)
            row.push_back(CostOf(OutcomeOf(blocks, begins, v, setting, run, true), chooseBy, grid));
    }
    return costs;
}

// Returns the first setting of the least mean cost over all viewpoints but `left` (-1: none).
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
    for (size_t v = 0; v + 1 < begins.size(); ++v)
        rival.viewpoints.push_back(
            OutcomeOf(blocks, begins, v, Best(costs, settings, int(v)), run, false));
    return rival;
}

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

// Returns the viewpoint where all of its blocks stop at one spp; without verdicts if `brief`.
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
