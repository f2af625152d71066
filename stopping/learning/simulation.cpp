#include "stopping/learning/simulation.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <memory>
#include <stdexcept>

#include "stopping/base/parallel.h"
#include "stopping/network/block_memory.h"
#include "stopping/rules/baselines.h"
#include "stopping/rules/entropy.h"
#include "stopping/rules/learned.h"
#include "stopping/rules/lnoise.h"
#include "stopping/rules/thresholds.h"
#include "stopping/rules/votes.h"
#include "stopping/signals/drop_history.h"

namespace lull {

namespace {

// Makes an outcome without verdicts: stopped at `spp`, or at the end of the recording if that is 0.
RuleOutcome MakeOutcome(const BlockRecording& recording, int spp) {
    if (recording.spp.empty()) throw std::invalid_argument("a recording has no passes");
    if (spp > 0) return {.stop = std::min(spp, kJudgedCap)};
    const int end = std::min(recording.spp.back(), kJudgedCap);
    return {.stop = end, .open = end < kJudgedCap};
}

// Returns whether a verdict is due: at every second pass, so that they are evenly spaced.
bool HasVerdict(const JudgedBlock& block, int spp) {
    return (spp - block.passSpp) % (2 * block.passSpp) == 0;
}

// Adds the verdicts of a rule of which only the stop is known: noisy before it.
void AddVerdictsOfStop(const JudgedBlock& block, RuleOutcome* outcome) {
    for (const int spp : block.recording->spp)
        if (HasVerdict(block, spp))
            outcome->verdicts.push_back({.spp = spp,
                                         .score = double(outcome->stop) / spp,
                                         .noisy = outcome->open || outcome->stop > spp});
}

// Checks that every second pass is enough for a model beyond 400 spp.
void CheckSpacing(const Model& model, const JudgedBlock& block) {
    const int n = model.settings.n;
    if (n % (2 * block.passSpp) != 0)
        throw std::invalid_argument("the model compares passes " + std::to_string(n) +
                                    " spp apart, but recordings have one every " +
                                    std::to_string(2 * block.passSpp) + " spp");
}

double ParseNumber(const std::string& text, const std::string& rule) {
    double value = 0;
    const char* end = text.data() + text.size();
    const auto [rest, error] = std::from_chars(text.data(), end, value);
    if (error != std::errc() || rest != end)
        throw std::invalid_argument("stopping rule '" + rule + "' cannot be simulated");
    return value;
}

Simulator ErrorSimulator(ErrorRule rule, double threshold) {
    return [=](const JudgedBlock& block) {
        return SimulateErrorRule(block, MakeErrorSeries(*block.recording, rule), threshold);
    };
}

Simulator LearnedSimulator(const std::string& path, const RuleContext& context) {
    const auto model = std::make_shared<const Model>(ReadModelFor(path, context));
    return [=](const JudgedBlock& block) {
        try {
            return SimulateLearned(block, *model);
        } catch (const std::invalid_argument& error) {
            throw std::runtime_error(path + ": " + error.what());
        }
    };
}

// Returns the end of the pass that reaches `spp`.
int PassReaching(int spp, int passSpp) { return (spp + passSpp - 1) / passSpp * passSpp; }

Simulator ThresholdsSimulator(const std::string& path) {
    const auto rows = std::make_shared<const std::vector<ThresholdsRow>>(ReadThresholds(path));
    return [=](const JudgedBlock& block) {
        const auto row = std::ranges::find(*rows, block.viewpoint, &ThresholdsRow::name);
        if (row == rows->end())
            throw std::runtime_error(path + ": has no row '" + block.viewpoint + "'");
        if (block.block >= int(row->spp.size()))
            throw std::runtime_error(path + ": '" + block.viewpoint +
                                     "' has no threshold for block " + std::to_string(block.block));
        return SimulateStop(block, PassReaching(row->spp[size_t(block.block)], block.passSpp));
    };
}

// Returns what the rule `entropy` compares with its threshold.
std::vector<double> EntropyErrors(const BlockRecording& recording,
                                  const NoiseVisibility& visibility) {
    std::vector<double> errors;
    DropHistory history;
    for (int i = 0; i < recording.Count(); ++i) {
        const int spp = recording.spp[size_t(i)];
        std::optional<std::vector<double>> visible;
        if (EntropyRuleLooks(spp, recording.spp.front())) {
            const std::span<const float> h = recording.Values(i, "h100");
            visible = AddVisible(spp, std::vector<double>(h.begin(), h.end()),
                                 LightnessOf(recording, i), visibility, &history);
        }
        errors.push_back(visible ? MeanVisible(*visible) : std::numeric_limits<double>::infinity());
    }
    return errors;
}

}  // namespace

ErrorSeries MakeErrorSeries(const BlockRecording& recording, ErrorRule rule,
                            const NoiseVisibility& visibility) {
    const bool votes = rule == ErrorRule::LNoise || rule == ErrorRule::Entropy;
    ErrorSeries series{.needed = votes ? VoteCounter().needed : 1};
    if (rule == ErrorRule::Entropy) {
        series.errors = EntropyErrors(recording, visibility);
        return series;
    }
    const auto lux = MakeLuxTile(1);  // says at which spp it looks
    for (int i = 0; i < recording.Count(); ++i) {
        double error = 0;
        if (rule == ErrorRule::Dammertz)
            error = recording.Values(i, "dammertz")[0];
        else if (rule == ErrorRule::LNoise)
            error = PooledRms(recording.Values(i, "masked_noise"));
        else if (lux->Need(recording.spp[size_t(i)]) != ViewNeed::Nothing)
            error = recording.Values(i, "luxtile")[0];
        else
            error = std::numeric_limits<double>::infinity();
        series.errors.push_back(error);
    }
    return series;
}

int FirstBelow(const ErrorSeries& series, double threshold) {
    int inRow = 0;
    for (size_t i = 0; i < series.errors.size(); ++i) {
        if (std::isinf(series.errors[i])) continue;  // no look, no vote
        inRow = series.errors[i] < threshold ? inRow + 1 : 0;
        if (inRow == series.needed) return int(i);
    }
    return -1;
}

RuleOutcome SimulateErrorRule(const JudgedBlock& block, const ErrorSeries& series, double threshold,
                              bool brief) {
    const BlockRecording& recording = *block.recording;
    const int first = FirstBelow(series, threshold);
    RuleOutcome outcome = MakeOutcome(recording, first < 0 ? 0 : recording.spp[size_t(first)]);
    if (brief) return outcome;
    for (size_t i = 0; i < recording.spp.size(); ++i)
        if (HasVerdict(block, recording.spp[i]))
            outcome.verdicts.push_back({.spp = recording.spp[i],
                                        .score = series.errors[i],
                                        .noisy = !(series.errors[i] < threshold)});
    return outcome;
}

RuleOutcome SimulateCycles(const JudgedBlock& block, double threshold, bool brief) {
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

RuleOutcome SimulateLearned(const JudgedBlock& block, const Model& model) {
    CheckSpacing(model, block);
    const BlockRecording& recording = *block.recording;
    const ModelSettings& settings = model.settings;
    const VoteSchedule schedule{
        .firstSpp = block.passSpp,
        .n = settings.n,
        .voteSpacing = settings.voteSpacing > 0 ? settings.voteSpacing : block.passSpp};
    BlockMemory memory(settings);
    VoteCounter votes{.needed = settings.votes};
    int stop = 0;
    std::vector<Verdict> verdicts;
    for (int i = 0; i < recording.Count(); ++i) {
        const int spp = recording.spp[size_t(i)];
        Verdict verdict{
            .spp = spp, .score = std::numeric_limits<double>::infinity(), .noisy = true};
        if (schedule.Records(spp)) {
            memory.Add(MeasuresOf(recording, i, settings));
            const auto window = schedule.Votes(spp) ? memory.WindowAt(spp) : std::nullopt;
            if (window) {
                verdict.score = NoisyProbability(model.network, *window);
                verdict.noisy = !(verdict.score < 0.5);
                votes.Cast(verdict.score);
                if (votes.Stops() && stop == 0) stop = spp;
            }
        }
        if (HasVerdict(block, spp)) verdicts.push_back(verdict);
    }
    RuleOutcome outcome = MakeOutcome(recording, stop);
    outcome.verdicts = std::move(verdicts);
    return outcome;
}

RuleOutcome SimulateStop(const JudgedBlock& block, int spp) {
    RuleOutcome outcome = MakeOutcome(*block.recording, std::max(1, spp));
    AddVerdictsOfStop(block, &outcome);
    return outcome;
}

Simulator MakeSimulator(const std::string& given, const RuleContext& context) {
    const size_t colon = given.find(':');
    const std::string kind = given.substr(0, colon);
    const std::string argument = colon == std::string::npos ? "" : given.substr(colon + 1);
    if (kind == "thresholds" && !argument.empty()) return ThresholdsSimulator(argument);
    // With its default, if it has one.
    std::string rule = MakeCriterionFactory(given, context).rule;
    rule = rule.substr(0, rule.find(", caution"));
    if (kind == "learned") return LearnedSimulator(ModelPath(argument, context.models), context);

    const double number = ParseNumber(rule.substr(rule.find(':') + 1), rule);
    if (kind == "dammertz") return ErrorSimulator(ErrorRule::Dammertz, number);
    if (kind == "luxtile") return ErrorSimulator(ErrorRule::LuxTile, number);
    if (kind == "lnoise") return ErrorSimulator(ErrorRule::LNoise, number / context.caution);
    if (kind == "entropy") return ErrorSimulator(ErrorRule::Entropy, number / context.caution);
    if (kind == "cycles")
        return [=](const JudgedBlock& block) { return SimulateCycles(block, number); };
    if (kind == "fixed")
        return [=](const JudgedBlock& block) {
            return SimulateStop(block, PassReaching(int(number), block.passSpp));
        };
    throw std::invalid_argument("stopping rule '" + rule + "' cannot be simulated");
}

std::vector<ViewpointOutcome> Simulate(std::span<const JudgedBlock> blocks, const Simulator& rule,
                                       const std::string& setting) {
    std::vector<RuleOutcome> outcomes(blocks.size());
    ForEachIndex(int(blocks.size()), [&](int i) { outcomes[size_t(i)] = rule(blocks[size_t(i)]); });
    std::vector<ViewpointOutcome> result;
    for (size_t i = 0; i < blocks.size(); ++i) {
        if (result.empty() || result.back().name != blocks[i].viewpoint)
            result.push_back({.name = blocks[i].viewpoint, .setting = setting});
        result.back().blocks.push_back(
            {.human = blocks[i].human, .outcome = std::move(outcomes[i])});
    }
    return result;
}

}  // namespace lull
