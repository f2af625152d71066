#include "stopping/lab/training/training_plan.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <filesystem>
#include <stdexcept>

#include "stopping/base/input_file.h"
#include "stopping/lab/evaluation/simulation.h"
#include "stopping/lab/recordings/extension.h"
#include "stopping/rules/learned.h"

namespace lull {

std::span<const TrainingPreset> TrainingPresets() {
    static const TrainingPreset presets[] = {
        {.name = "entropy",
         .settings = {.k = 2,
                      .features = {Feature::VisibleDrop},
                      .takesMean = true,
                      .spacing = Spacing::Geometric,
                      .ratio = 1.4142,
                      .visibility = {.mask = 1e9, .flare = 0, .nearness = 0.25},
                      .peakLimit = 1.1},
         .training = {.units = {8, 4},
                      .dropout = 0,
                      .learningRate = 0.003,
                      .epochs = 60,
                      .balanceViewpoints = true,
                      .balanceClasses = false}},
        {.name = "paper"}};
    return presets;
}

namespace {

std::string FileText(const std::string& path) {
    return std::filesystem::path(path).filename().string() + " " + FileChecksum(path);
}

template <typename T>
std::string ListText(const std::vector<T>& list) {
    std::string text;
    for (const T& item : list) text += fmt::format("{}{}", text.empty() ? "" : ",", item);
    return text.empty() ? "none" : text;
}

std::string BlocksText(std::span<const LabelledBlock> blocks) {
    std::map<std::string, std::string> viewpoints;
    for (const LabelledBlock& block : blocks)
        viewpoints[block.viewpoint] += fmt::format(" {}", block.block);
    std::string text;
    for (const auto& [name, numbers] : viewpoints)
        text += fmt::format("{}{}:{}", text.empty() ? "" : "\n", name, numbers);
    return text.empty() ? "none" : text;
}

}  // namespace

std::vector<BlockSplit> MakeSplits(const TrainingPlan& plan,
                                   std::span<const LabelledBlock> blocks) try {
    std::vector<BlockSplit> splits;
    if (plan.crossValidate) splits = LeaveEachOut(blocks, plan.together);
    for (BlockSplit& split : splits) split.name = "without " + split.name;
    if (!plan.withLast) return splits;
    BlockSplit split = LeaveOut(blocks, plan.leaveOut);
    if (!plan.split.empty()) try {
            KeepListed(ReadThresholds(plan.split), &split);
        } catch (const std::invalid_argument& error) {
            throw std::runtime_error(plan.split + ": " + error.what());
        }
    split.name = "";
    splits.push_back(std::move(split));
    return splits;
} catch (const std::invalid_argument& error) {
    throw std::runtime_error(error.what());
}

void CheckSpacing(const ModelSettings& settings, int passSpp) {
    if (passSpp > 0 && settings.n % passSpp != 0)
        throw std::runtime_error(
            fmt::format("--n must be a multiple of the recordings' pass of {} spp, and {} is none",
                        passSpp, settings.n));
}

namespace {

std::string ScoresText(const std::vector<ViewpointOutcome>& viewpoints,
                       const ScoreOptions& options) {
    const Scores j = Score(viewpoints, options);
    return fmt::format("critical error at {:g} %: {:.2f} %, mean error {:.0f} spp, AUC {:.4f}",
                       options.margins.at(0), 100 * j.criticalErrors.at(0), j.absoluteError,
                       j.auc.value_or(0.5));
}

void AddOutcomes(const Network& network, const ModelSettings& settings,
                 std::span<const LabelledBlock> blocks, std::vector<ViewpointOutcome>* viewpoints) {
    const auto model = std::make_shared<const Model>(Model{network, settings, ""});
    const auto simulator = [&](const LabelledBlock& block) {
        return SimulateRule(block, LearnedRule(model, block.passSpp));
    };
    for (ViewpointOutcome& viewpoint : Simulate(blocks, simulator))
        viewpoints->push_back(std::move(viewpoint));
}

struct NetworkOutcomes {
    std::string name;
    std::vector<LabelledBlock> blocks = {};
    std::vector<ViewpointOutcome> recorded = {}, extended = {};

    void Add(const Network& network, const ModelSettings& settings,
             std::span<const LabelledBlock> judged) {
        blocks.insert(blocks.end(), judged.begin(), judged.end());
        AddOutcomes(network, settings, judged, &recorded);
        AddOutcomes(network, settings, ExtendBlocks(judged).blocks, &extended);
    }
};

// Trains a network, or goes on with training number `index` of the checkpoint. Nothing if it was
// cancelled: the checkpoint has it, but is not written.
std::optional<Network> TrainNetwork(const ModelSettings& settings, const TrainingOptions& options,
                                    const BlockSplit& split, size_t index,
                                    TrainingCheckpoint* checkpoint, const TrainingEvents& events) {
    const TrainingSamples samples = MakeSamples(split.training, settings);
    Trainer trainer(samples, options);
    checkpoint->Restore(index, &trainer);
    const bool isNew = !trainer.IsDone();
    if (isNew) events.begin(samples, trainer.Progress());
    while (!trainer.IsDone() && !events.isCancelled()) {
        trainer.Step();
        events.step(trainer);
        if (checkpoint->IsDue()) {
            checkpoint->Set(index, trainer.Save());
            checkpoint->Write();
        }
    }
    if (isNew) events.end(trainer.Progress());
    checkpoint->Set(index, trainer.Save());
    if (!trainer.IsDone()) return {};
    return trainer.Result();
}

}  // namespace

std::optional<TrainingResult> TrainAll(
    const TrainingPlan& plan, std::span<const BlockSplit> splits, TrainingCheckpoint* checkpoint,
    const std::function<TrainingEvents(const BlockSplit&)>& eventsOf) {
    TrainingResult result;
    std::vector<NetworkOutcomes> outcomes;
    if (plan.crossValidate) outcomes.push_back({.name = "each viewpoint left out"});
    for (size_t i = 0; i < splits.size(); ++i) {
        const BlockSplit& split = splits[i];
        std::optional<Network> network;
        try {
            network =
                TrainNetwork(plan.settings, plan.training, split, i, checkpoint, eventsOf(split));
        } catch (const std::invalid_argument& error) {
            throw std::runtime_error(
                fmt::format("{}: {}", fmt::join(plan.datasets, ", "), error.what()));
        }
        if (!network) {
            checkpoint->Write();
            return {};
        }
        const bool isLast = plan.withLast && i + 1 == splits.size();
        const bool isTested = !split.test.empty();
        if (isLast)
            outcomes.push_back({.name = isTested ? "blocks left out" : "blocks trained on"});
        outcomes.back().Add(*network, plan.settings, isTested ? split.test : split.training);
        result.network = std::move(*network);
    }
    for (NetworkOutcomes& o : outcomes)
        AddTwoFigures(
            o.blocks, {.name = o.name, .viewpoints = std::move(o.recorded)},
            [&] { return EvaluatedRule{.name = o.name, .viewpoints = std::move(o.extended)}; },
            &result.rules);
    return result;
}

std::map<std::string, std::string> MakeRecord(const TrainingPlan& plan, const BlockSplit& split,
                                              const TrainingResult& result,
                                              const ScoreOptions& scoring) {
    const TrainingOptions& t = plan.training;
    std::string files;
    for (const std::string& path : plan.datasets)
        files.append(files.empty() ? "" : "\n").append(FileText(path));
    std::map<std::string, std::string> record = {
        {"version", plan.version},
        {"datasets", files},
        {"human", FileText(plan.human)},
        {"training_blocks", BlocksText(split.training)},
        {"test_blocks", BlocksText(split.test)},
        {"units", ListText(t.units)},
        {"dropout", fmt::format("{}", t.dropout)},
        {"learning_rate", fmt::format("{}", t.learningRate)},
        {"batch", fmt::format("{}", t.batch)},
        {"epochs", fmt::format("{}", t.epochs)},
        {"seed", fmt::format("{}", t.seed)},
        {"balance_viewpoints", t.balanceViewpoints ? "1" : "0"},
        {"balance_classes", t.balanceClasses ? "1" : "0"}};
    for (const EvaluatedRule& rule : result.rules)
        record["judged on " + LabelOf(rule)] = ScoresText(rule.viewpoints, scoring);
    return record;
}

}  // namespace lull
