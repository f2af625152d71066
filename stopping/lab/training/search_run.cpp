#include "stopping/lab/training/search_run.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <optional>
#include <stdexcept>

namespace lull {

namespace {

using Clock = std::chrono::steady_clock;

double SecondsSince(Clock::time_point start) {
    return std::chrono::duration<double>(Clock::now() - start).count();
}

TrainingPlan PlanAt(const TrainingPlan& plan, std::span<const SearchAxis> axes,
                    const std::vector<std::string>& values, const OptionSetter& set) {
    std::vector<OptionValue> options;
    for (size_t i = 0; i < axes.size(); ++i) options.push_back({axes[i].option, values[i]});
    TrainingPlan changed = plan;
    set(options, &changed);
    return changed;
}

std::string NameOf(std::span<const SearchAxis> axes, const std::vector<std::string>& values) {
    std::string name;
    for (size_t i = 0; i < axes.size(); ++i)
        name += fmt::format("{}{} {}", i > 0 ? ", " : "", axes[i].option, values[i]);
    return name;
}

// Leaves only verdicts on what the network was shown: AUC and accuracy are to be those of its
// answers, however far apart these are.
void KeepAnswers(std::vector<ViewpointOutcome>* viewpoints) {
    for (ViewpointOutcome& viewpoint : *viewpoints)
        for (BlockOutcome& block : viewpoint.blocks)
            std::erase_if(block.outcome.verdicts,
                          [](const Verdict& v) { return !std::isfinite(v.score); });
}

// Trains and judges a combination. Nothing if it was cancelled. `onStep` is told how many of its
// networks are trained, and of the one under way.
std::optional<SearchResult> Try(const Trial& trial, TrainingCheckpoint* checkpoint,
                                const std::function<bool()>& isCancelled,
                                const std::function<void(size_t trained, const Trainer&)>& onStep) {
    const ModelSettings& settings = trial.plan.settings;
    std::vector<ViewpointOutcome> training, test;
    for (size_t i = 0; i < trial.splits.size(); ++i) {
        const BlockSplit& split = trial.splits[i];
        const TrainingEvents events = {
            .begin = [](const TrainingSamples&, const TrainingProgress&) {},
            .step = [&](const Trainer& trainer) { onStep(i, trainer); },
            .end = [](const TrainingProgress&) {},
            .isCancelled = isCancelled};
        const std::optional<Network> network =
            TrainNetwork(settings, trial.plan.training, split, i, checkpoint, events);
        if (!network) return {};
        AddOutcomes(*network, settings, split.training, &training);
        AddOutcomes(*network, settings, split.test, &test);
    }
    KeepAnswers(&training);
    KeepAnswers(&test);
    const JudgeOptions judge{.grid = settings.n, .margins = {2}};
    const Judgement onTraining = Judge(training, judge), onTest = Judge(test, judge);
    constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
    return SearchResult{.values = trial.values,
                        .testAuc = onTest.auc.value_or(unknown),
                        .testAccuracy = onTest.accuracy.value_or(unknown),
                        .trainingAuc = onTraining.auc.value_or(unknown),
                        .trainingAccuracy = onTraining.accuracy.value_or(unknown),
                        .criticalError = onTest.criticalErrors.at(0),
                        .early = onTest.early,
                        .late = onTest.late};
}

SearchResult NothingLearned(const std::vector<std::string>& values) {
    constexpr double n = std::numeric_limits<double>::quiet_NaN();
    return {values, n, n, n, n, n, n, n};
}

}  // namespace

void CheckGrid(const TrainingPlan& plan, const std::string& grid, std::span<const SearchAxis> axes,
               const OptionSetter& set) {
    for (const SearchAxis& axis : axes)
        for (const std::string& value : axis.values) try {
                PlanAt(plan, {&axis, 1}, {value}, set);
            } catch (const std::invalid_argument& error) {
                throw std::runtime_error(fmt::format("{}:{}: {} {}: {}", grid, axis.line,
                                                     axis.option, value, error.what()));
            }
}

std::vector<Trial> MakeTrials(const TrainingPlan& plan, const std::string& grid,
                              std::span<const SearchAxis> axes,
                              const std::vector<JudgedBlock>& judged, const OptionSetter& set,
                              const WarningSink& warn) {
    std::vector<Trial> trials(CombinationCount(axes));
    const auto each = [&](auto&& work) {
        for (size_t i = 0; i < trials.size(); ++i) try {
                trials[i].values = CombinationAt(axes, i);
                trials[i].name = NameOf(axes, trials[i].values);
                work(trials[i]);
            } catch (const std::exception& error) {
                throw std::runtime_error(
                    fmt::format("{}: {}: {}", grid, trials[i].name, error.what()));
            }
    };
    std::vector<ModelSettings> settings;
    each([&](Trial& trial) {
        trial.plan = PlanAt(plan, axes, trial.values, set);
        settings.push_back(trial.plan.settings);
    });
    const std::vector<JudgedBlock> blocks = KeepRecordedForAll(judged, settings, warn);
    each([&](Trial& trial) {
        CheckSpacing(trial.plan.settings, blocks.front().passSpp);
        MeasuresOf(*blocks.front().recording, 0, trial.plan.settings);
        trial.splits = MakeSplits(trial.plan, blocks);
    });
    return trials;
}

std::string SearchDataText(const TrainingPlan& plan, const Trial& first) {
    std::string text;
    for (const auto& [name, value] : MakeRecord(plan, first.splits.front()))
        text += name + "=" + value + "\n";
    const ModelSettings& s = plan.settings;
    return text + fmt::format("{} {} {} {} {} {} {} {} {}", s.k, s.n, s.m, FeatureNames(s.features),
                              PoolNames(s.pools), s.snorm, s.bnorm, s.votes, s.voteSpacing);
}

double SearchProgress::Share() const {
    const TrainingProgress p = trainer.Progress();
    const double share = double(p.samples) / double(p.allSamples);
    return (double(trained) + share) / double(trial.splits.size());
}

SearchOutcome RunTrials(std::span<const Trial> trials, std::span<const SearchResult> known,
                        TrainingCheckpoint* checkpoint, const SearchEvents& events) {
    SearchOutcome outcome;
    std::vector<SearchResult>& results = outcome.results;
    std::vector<double> seconds;
    for (const Trial& trial : trials) {
        const auto old = std::ranges::find(known, trial.values, &SearchResult::values);
        if (old != known.end()) {
            results.push_back(*old);
            seconds.push_back(old->seconds);
            continue;
        }
        const Clock::time_point start = Clock::now();
        const auto onStep = [&](size_t trained, const Trainer& trainer) {
            events.step({trial, seconds, trained, trainer, SecondsSince(start)});
        };
        std::optional<SearchResult> result;
        try {
            result = Try(trial, checkpoint, events.isCancelled, onStep);
        } catch (const CheckpointError&) {
            throw;
        } catch (const std::exception& error) {  // the training has diverged, or has no samples
            events.warn(fmt::format("{}: {}", trial.name, error.what()));
            result = NothingLearned(trial.values);
        }
        if (!result) {
            checkpoint->Write();
            events.keep(results);
            outcome.cancelled = true;
            return outcome;
        }
        result->seconds = SecondsSince(start);
        seconds.push_back(result->seconds);
        results.push_back(std::move(*result));
        checkpoint->Remove();
        events.keep(results);
    }
    return outcome;
}

}  // namespace lull
