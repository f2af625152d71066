// `lull train`: learns from people when to stop.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

#include "renderer/base/error.h"
#include "renderer/commands/command.h"
#include "renderer/commands/evaluation_table.h"
#include "renderer/commands/interrupt.h"
#include "renderer/commands/judged_blocks.h"
#include "renderer/commands/search.h"
#include "renderer/commands/training_printer.h"
#include "renderer/commands/training_run.h"
#include "renderer/output/file_io.h"
#include "stopping/base/parallel.h"
#include "stopping/learning/certainty.h"
#include "stopping/network/model_file.h"

namespace lull {

namespace {

std::string JudgementText(const std::vector<ViewpointOutcome>& viewpoints,
                          const JudgeOptions& options) {
    const Judgement j = Judge(viewpoints, options);
    return fmt::format("critical error at {:g} %: {:.2f} %, mean error {:.0f} spp, AUC {:.4f}",
                       options.margins.at(0), 100 * j.criticalErrors.at(0), j.absoluteError,
                       j.auc.value_or(0.5));
}

// Says how far from the stops people's thresholds lie.
std::string CertaintyText(const std::vector<ViewpointOutcome>& viewpoints,
                          const std::vector<double>& logRatios) {
    return fmt::format(
        "80 % of the thresholds of people lie between {:.2f} and {:.2f} times the stop; of each "
        "viewpoint, {:.1f} % between those that the others give",
        std::exp(logRatios[1]), std::exp(logRatios[9]), 100 * RangeCoverage(viewpoints));
}

// Shows a training.
TrainingEvents PrintTo(TrainingPrinter* printer, const BlockSplit& split, bool quiet) {
    return {.begin =
                [=, &split](const TrainingSamples& samples, const TrainingProgress& progress) {
                    const auto noisy = std::ranges::count(samples.noisy, char(1));
                    if (!quiet)
                        fmt::print(
                            stderr, "lull: {}{} windows of {} blocks to train on, {:.1f}% noisy\n",
                            split.name.empty() ? "" : split.name + ": ", samples.Count(),
                            split.training.size(), 100.0 * double(noisy) / double(samples.Count()));
                    printer->Begin(split.name, progress);
                },
            .step =
                [=](const Trainer& trainer) {
                    if (printer->IsDue()) printer->Print(trainer.Progress());
                },
            .end = [=](const TrainingProgress& progress) { printer->Finish(progress); }};
}

ExitCode RunTrain(const TrainOptions& options) {
    if (!options.output.empty()) CheckWritable(options.output);
    if (!options.csv.empty()) CheckWritable(options.csv);
    const std::vector<ViewpointRecording> viewpoints = ReadDatasets(options.datasets);
    const std::vector<JudgedBlock> judged =
        ReadJudgedBlocks(viewpoints, options.human, options.without);
    const std::vector<JudgedBlock> blocks = KeepRecorded(judged, options.settings);
    if (blocks.empty()) throw Error("no block was recorded with attributes26");
    if (blocks.size() < judged.size())
        fmt::print(stderr, "lull: {} of {} blocks were recorded without attributes26\n",
                   judged.size() - blocks.size(), judged.size());
    CheckSpacing(options.settings, blocks.front().passSpp);
    const std::vector<BlockSplit> splits = MakeSplits(options, blocks);
    TrainingCheckpoint checkpoint(options.output.empty() ? "" : options.output + ".checkpoint",
                                  options.checkpointInterval);
    if (options.resume) checkpoint.Read();
    TrainingPrinter printer(StyleOf(options), stderr);
    CatchInterrupts();

    const JudgeOptions judge{.grid = options.settings.n};
    std::vector<JudgedRule> rules;
    if (options.crossValidate) rules.push_back({.name = "each viewpoint left out"});
    std::optional<Network> network;
    for (size_t i = 0; i < splits.size(); ++i) {
        network = TrainNetwork(options, splits[i], i, &checkpoint,
                               PrintTo(&printer, splits[i], options.quiet));
        if (!network) {
            checkpoint.Write();
            if (!options.quiet && !checkpoint.Path().empty())
                fmt::print(stderr, "lull: interrupted; --resume goes on from {}\n",
                           checkpoint.Path());
            return kInterrupted;
        }
        const bool isFinal = !options.output.empty() && i + 1 == splits.size();
        const bool isTested = !splits[i].test.empty();
        if (isFinal) rules.push_back({.name = isTested ? "blocks left out" : "blocks trained on"});
        AddOutcomes(*network, options.settings, isTested ? splits[i].test : splits[i].training,
                    &rules.back().viewpoints);
    }
    std::vector<double> logRatios;
    std::string certainty;
    if (options.crossValidate) {
        logRatios = LogRatioQuantiles(rules.front().viewpoints);
        certainty = CertaintyText(rules.front().viewpoints, logRatios);
    }
    if (!options.output.empty()) {
        std::map<std::string, std::string> record = MakeRecord(options, splits.back());
        for (const JudgedRule& rule : rules)
            record["judged on " + rule.name] = JudgementText(rule.viewpoints, judge);
        if (!certainty.empty()) record["certainty"] = certainty;
        WriteModel(options.output, *network, options.settings, record, logRatios);
        checkpoint.Remove();
    }
    PrintEvaluation(stdout, rules, judge, true);
    if (!certainty.empty()) fmt::print("\n{}\n", certainty);
    if (!options.csv.empty()) WriteFileAtomically(options.csv, EvaluationCsv(rules, judge));
    return kDone;
}

}  // namespace

void AddTrainCommand(CLI::App& app, Command* command) {
    CLI::App* train = app.add_subcommand("train", "Learns from people when to stop.");
    auto options = std::make_shared<TrainOptions>();
    AddTrainOptions(*train, options.get());
    train->callback([=] {
        CompleteTrainOptions(options.get());
        *command = [=] {
            ExitCode code = kDone;
            RunWithThreads(options->threads, [&] {
                code = options->search.empty() ? RunTrain(*options) : RunSearch(*options);
            });
            return code;
        };
    });
}

}  // namespace lull
