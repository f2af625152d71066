#include "stopping/lab/evaluation/simulation.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <stdexcept>

#include "stopping/base/input_file.h"
#include "stopping/base/parallel.h"
#include "stopping/lab/evaluation/evaluated_rules.h"
#include "stopping/rules/rule_table.h"
#include "stopping/rules/thresholds.h"
#include "stopping/signals/lightness_noise.h"

namespace lull {

namespace {

// Makes an outcome without verdicts: stopped at `spp`, or at the end of the recording if that is 0.
RuleOutcome MakeOutcome(const BlockRecording& recording, int spp) {
    if (recording.spp.empty()) throw std::invalid_argument("a recording has no passes");
    if (spp > 0) return {.stop = std::min(spp, kMostShownSpp)};
    const int end = std::min(recording.spp.back(), kMostShownSpp);
    return {.stop = end, .open = end < kMostShownSpp};
}

// Verdicts are due at every second pass, evenly; at every record where these come at any spp.
bool HasVerdict(const LabelledBlock& block, int spp) {
    return block.passSpp == 0 || (spp - block.passSpp) % (2 * block.passSpp) == 0;
}

void AddVerdictsOfStop(const LabelledBlock& block, RuleOutcome* outcome) {
    for (const int spp : block.recording->spp)
        if (HasVerdict(block, spp))
            outcome->verdicts.push_back({.spp = spp,
                                         .score = double(outcome->stop) / spp,
                                         .noisy = outcome->open || outcome->stop > spp});
}

void AddVerdicts(const LabelledBlock& block, std::span<const double> numbers, double threshold,
                 RuleOutcome* outcome) {
    const std::vector<int>& spp = block.recording->spp;
    for (size_t i = 0; i < spp.size(); ++i)
        if (HasVerdict(block, spp[i]))
            outcome->verdicts.push_back(
                {.spp = spp[i], .score = numbers[i], .noisy = !(numbers[i] < threshold)});
}

// Checks that every second pass is enough for the comparisons of a rule beyond 400 spp.
void CheckSpacing(const Rule& rule, const LabelledBlock& block) {
    if (block.passSpp > 0 && rule.spacing % (2 * block.passSpp) != 0)
        throw std::invalid_argument("the model compares passes " + std::to_string(rule.spacing) +
                                    " spp apart, but recordings have one every " +
                                    std::to_string(2 * block.passSpp) + " spp");
}

// Checks that records at any spp were near enough to each other for the rule to look at one.
void CheckLookedAt(std::span<const Decision> decisions, const LabelledBlock& block) {
    if (block.passSpp > 0 || std::ranges::any_of(decisions, &Decision::checked)) return;
    const std::vector<int>& spp = block.recording->spp;
    std::string text;
    for (size_t i = 0; i < std::min(spp.size(), size_t(4)); ++i)
        text += (i ? ", " : "") + std::to_string(spp[i]);
    throw std::invalid_argument(
        "pictures at " + text + (spp.size() > 4 ? ", ..." : "") +
        " spp lie too far apart for it: it compares them, and has checked none; take them at "
        "multiples of 20 or 40 spp, or at most 1.4 times the spp of the one before");
}

// Returns PeakOverLimit() of record i; of older recordings a lower bound by root mean squares.
double PeakIn(const BlockRecording& recording, int i, const Rule& rule) {
    if (rule.peak.most <= 0 || !HasHalves(recording)) return 0;
    const auto values = [&](const char* channel) { return recording.Values(i, channel); };
    const double noise =
        recording.absent[ChannelIndex("peak_noise")]
            ? PeakOf(BellShapedPeaks(values("noise"), values("masked_noise"), values("half_noise")))
            : PeakOf(values("peak_noise"));
    return PeakOverLimit(rule, noise, recording.spp[size_t(i)]);
}

std::vector<double> NumbersOf(std::span<const Decision> decisions) {
    std::vector<double> numbers;
    for (const Decision& decision : decisions)
        numbers.push_back(decision.checked ? decision.value
                                           : std::numeric_limits<double>::infinity());
    return numbers;
}

int PassReaching(int spp, const LabelledBlock& block) {
    if (block.passSpp > 0) return (spp + block.passSpp - 1) / block.passSpp * block.passSpp;
    const std::vector<int>& recorded = block.recording->spp;
    const auto at = std::ranges::lower_bound(recorded, spp);
    return at == recorded.end() ? spp : *at;
}

Simulator ThresholdsSimulator(const std::string& path) {
    const auto rows = std::make_shared<const std::vector<ThresholdsRow>>(ReadThresholds(path));
    return [=](const LabelledBlock& block) {
        return SimulateStop(block, PassReaching(ThresholdIn(*rows, path, block), block));
    };
}

}  // namespace

std::vector<Decision> ReplayRule(const LabelledBlock& block, const Rule& rule,
                                 std::vector<std::optional<double>>* noise) {
    CheckSpacing(rule, block);
    const BlockRecording& recording = *block.recording;
    RuleCriterion criterion(std::make_shared<const Rule>(rule), {.index = block.block});
    std::vector<Decision> decisions;
    for (int i = 0; i < recording.Count(); ++i) {
        const int spp = recording.spp[size_t(i)];
        decisions.push_back(criterion.IsDue(spp)
                                ? criterion.Decide(spp, RecordedSignals(rule, recording, i),
                                                   PeakIn(recording, i, rule))
                                : criterion.Decide(spp, {}));
        if (noise) noise->push_back(criterion.NetworkNoise());
    }
    CheckLookedAt(decisions, block);
    return decisions;
}

ErrorSeries MakeErrorSeries(const LabelledBlock& block, const Rule& rule) {
    Rule plain = rule;
    plain.peak = {};  // numbers are compared with other thresholds than the rule's
    return {.errors = NumbersOf(ReplayRule(block, plain)), .needed = std::max(1, rule.votes)};
}

int FirstBelow(const ErrorSeries& series, double threshold) {
    int votes = 0;
    for (size_t i = 0; i < series.errors.size(); ++i) {
        if (std::isinf(series.errors[i])) continue;  // no check, no vote
        votes = series.errors[i] < threshold ? votes + 1 : 0;
        if (votes >= series.needed) return int(i);
    }
    return -1;
}

RuleOutcome SimulateErrorRule(const LabelledBlock& block, const ErrorSeries& series,
                              double threshold, bool brief) {
    const BlockRecording& recording = *block.recording;
    const int first = FirstBelow(series, threshold);
    RuleOutcome outcome = MakeOutcome(recording, first < 0 ? 0 : recording.spp[size_t(first)]);
    if (!brief) AddVerdicts(block, series.errors, threshold, &outcome);
    return outcome;
}

RuleOutcome SimulateCycles(const LabelledBlock& block, double threshold, bool brief) {
    if (!HasHalves(*block.recording))
        throw std::invalid_argument(
            "cycles compares a half of the samples, which pictures by themselves do not have");
    const auto found = std::ranges::find(kCyclesThresholds, threshold);
    if (found == kCyclesThresholds.end()) {
        std::string message = "cycles is recorded only at the thresholds";
        for (const double t : kCyclesThresholds) {
            std::string text = std::to_string(t);
            text.erase(text.find_last_not_of('0') + 1);
            message += " " + text;
        }
        throw std::invalid_argument(message);
    }
    const size_t index = size_t(found - kCyclesThresholds.begin());
    RuleOutcome outcome = MakeOutcome(*block.recording, block.recording->cyclesStops[index]);
    if (!brief) AddVerdictsOfStop(block, &outcome);
    return outcome;
}

RuleOutcome SimulateRule(const LabelledBlock& block, const Rule& rule) {
    const std::vector<Decision> decisions = ReplayRule(block, rule);
    const auto last = std::ranges::find(decisions, true, &Decision::stop);
    RuleOutcome outcome = MakeOutcome(
        *block.recording,
        last == decisions.end() ? 0 : block.recording->spp[size_t(last - decisions.begin())]);
    AddVerdicts(block, NumbersOf(decisions), rule.threshold, &outcome);
    return outcome;
}

int ThresholdIn(std::span<const ThresholdsRow> rows, const std::string& path,
                const LabelledBlock& block) {
    const auto row = std::ranges::find(rows, block.viewpoint, &ThresholdsRow::name);
    if (row == rows.end() || size_t(block.block) >= row->spp.size())
        throw std::runtime_error(path + ": has no threshold for block " +
                                 std::to_string(block.block) + " of '" + block.viewpoint + "'");
    return row->spp[size_t(block.block)];
}

RuleOutcome SimulateStop(const LabelledBlock& block, int spp) {
    RuleOutcome outcome = MakeOutcome(*block.recording, std::max(1, spp));
    AddVerdictsOfStop(block, &outcome);
    return outcome;
}

Simulator MakeSimulator(const std::string& text, const RuleContext& context) {
    // Each viewpoint has a row of its own.
    const RecordedRule* entry = FindRecordedRule(text);
    if (entry && entry->name == "thresholds" && !ArgumentOf(text).empty())
        return ThresholdsSimulator(ArgumentOf(text));
    if (entry && entry->replay == Replay::Unknown)
        throw std::invalid_argument("stopping rule '" + Printable(text) +
                                    "': recordings do not contain denoised images; "
                                    "evaluate the thresholds file of a render instead");
    const auto rule = std::make_shared<const Rule>(ParseRule(text, context));
    const Replay replay = entry->replay;
    if (replay == Replay::Counts)
        return [rule](const LabelledBlock& block) {
            return SimulateStop(block, PassReaching(rule->stopAt({.index = block.block}), block));
        };
    if (replay == Replay::RanAlong)
        return
            [rule](const LabelledBlock& block) { return SimulateCycles(block, rule->threshold); };
    if (!HasRecordedSignals(*rule))
        throw std::invalid_argument(
            "stopping rule '" + rule->text +
            "' cannot be simulated: recordings do not have what it measures");
    return [rule](const LabelledBlock& block) {
        try {
            return SimulateRule(block, *rule);
        } catch (const std::invalid_argument& error) {
            throw std::runtime_error("stopping rule '" + rule->text + "': " + error.what());
        }
    };
}

std::vector<ViewpointOutcome> Simulate(std::span<const LabelledBlock> blocks,
                                       const Simulator& rule) {
    std::vector<RuleOutcome> outcomes(blocks.size());
    ForEachIndex(int(blocks.size()), [&](int i) { outcomes[size_t(i)] = rule(blocks[size_t(i)]); });
    std::vector<ViewpointOutcome> result;
    for (size_t i = 0; i < blocks.size(); ++i) {
        if (result.empty() || result.back().name != blocks[i].viewpoint)
            result.push_back({.name = blocks[i].viewpoint});
        result.back().blocks.push_back({.human = blocks[i].human,
                                        .outcome = std::move(outcomes[i]),
                                        .block = blocks[i].block});
    }
    return result;
}

namespace {

bool HasOpen(const EvaluatedRule& rule) {
    for (const ViewpointOutcome& viewpoint : rule.viewpoints)
        for (const BlockOutcome& block : viewpoint.blocks)
            if (block.outcome.open) return true;
    return false;
}

void MarkOpen(std::span<const LabelledBlock> blocks, EvaluatedRule* rule) {
    size_t next = 0;
    for (ViewpointOutcome& viewpoint : rule->viewpoints)
        for (BlockOutcome& block : viewpoint.blocks) {
            const int end = blocks[next++].recording->spp.back();
            block.outcome.open = end < kMostShownSpp && block.outcome.stop > end;
        }
}

}  // namespace

void AddTwoFigures(std::span<const LabelledBlock> blocks, EvaluatedRule recorded,
                   const std::function<EvaluatedRule()>& extend,
                   std::vector<EvaluatedRule>* rules) {
    if (!HasOpen(recorded)) {
        rules->push_back(std::move(recorded));
        return;
    }
    recorded.openStops = OpenStops::Ends;
    rules->push_back(std::move(recorded));
    EvaluatedRule extended = extend();
    MarkOpen(blocks, &extended);
    extended.openStops = OpenStops::Extended;
    rules->push_back(std::move(extended));
}

}  // namespace lull
