// `lull train`: trains a stopping rule on human thresholds.
#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "renderer/commands/command.h"
#include "renderer/commands/render_job.h"
#include "renderer/files/file_io.h"
#include "renderer/lab/commands/tables.h"
#include "renderer/lab/commands/train_options.h"
#include "renderer/lab/commands/training_printer.h"
#include "stopping/base/parallel.h"
#include "stopping/lab/recordings/labelled_blocks.h"
#include "stopping/lab/training/training_plan.h"
#include "stopping/network/model_file.h"

namespace lull::train {

namespace {

// Shows a training.
TrainingEvents PrintTo(TrainingPrinter* printer, const Messages& messages, const BlockSplit& split,
                       bool quiet) {
    return {
        .begin =
            [=, &split](const TrainingSamples& samples, const TrainingProgress& progress) {
                const auto noisy = std::ranges::count(samples.noisy, char(1));
                if (!quiet)
                    messages.Note(fmt::format(
                        "{}{} windows of {} blocks to train on, {:.1f}% noisy",
                        split.name.empty() ? "" : split.name + ": ", samples.Count(),
                        split.training.size(), 100.0 * double(noisy) / double(samples.Count())));
                printer->Begin(split.name, progress);
            },
        .step =
            [=](const Trainer& trainer) {
                if (printer->IsDue()) printer->Print(trainer.Progress());
            },
        .end = [=](const TrainingProgress& progress) { printer->Finish(progress); },
        .isCancelled = Interrupted};
}

ExitCode RunTrain(const TrainOptions& options) {
    const TrainingPlan& plan = options.plan;
    const std::string checkpointName = options.output.empty() ? "" : options.output + ".checkpoint";
    CheckOutputs(
        std::vector<NamedFile>{
            {"-o", options.output}, {"the checkpoint", checkpointName}, {"--csv", options.csv}},
        InputsOf(plan));
    std::optional<FileLock> lock;
    if (!checkpointName.empty()) lock.emplace(LockCheckpointFile(checkpointName));
    const Messages messages{.isJson = options.jsonProgress};
    const auto note = [&](const std::string& message) { messages.Note(message); };
    const std::vector<ViewpointRecording> viewpoints = ReadDatasets(plan.datasets);
    const std::vector<LabelledBlock> blocks = KeepRecorded(
        ReadLabelledBlocks(viewpoints, plan.human, plan.without, note), plan.settings, note);
    CheckSpacing(plan.settings, blocks.front().passSpp);
    const std::vector<BlockSplit> splits = MakeSplits(plan, blocks);
    TrainingCheckpoint checkpoint(checkpointName, options.checkpointInterval, WriteBytes);
    if (options.resume) checkpoint.Read();
    TrainingPrinter printer(StyleOfReports(options.jsonProgress, options.quiet), stderr);
    CatchInterrupts();

    const std::optional<TrainingResult> result = TrainAll(
        plan, splits, &checkpoint,
        [&](const BlockSplit& split) { return PrintTo(&printer, messages, split, options.quiet); });
    if (!result) {
        if (!options.quiet && !checkpoint.Path().empty())
            messages.Note("interrupted; --resume continues from " + checkpoint.Path());
        return kInterrupted;
    }
    const ScoreOptions scoring{.grid = plan.settings.n};
    if (!options.output.empty()) {
        WriteModel(options.output, result->network, plan.settings,
                   MakeRecord(plan, splits.back(), *result, scoring));
        checkpoint.Remove();
    }
    PrintEvaluation(stdout, result->rules, scoring, true);
    if (!options.csv.empty())
        WriteFileAtomically(options.csv, EvaluationCsv(result->rules, scoring));
    return kDone;
}

}  // namespace

void AddCommand(CLI::App& app, Command* command) {
    CLI::App* train = app.add_subcommand("train", "Trains a stopping rule on human thresholds.");
    auto options = std::make_shared<TrainOptions>();
    AddTrainOptions(*train, options.get());
    train->callback([=] {
        CompleteTrainOptions(options.get());
        *command = [=] {
            if (options->listsValues) {
                fmt::print("{}", ValuesText(options->plan));
                return kDone;
            }
            ExitCode code = kDone;
            RunWithThreads(options->threads, [&] { code = RunTrain(*options); });
            return code;
        };
    });
}

}  // namespace lull::train
