// `lull train`: learns from people when to stop.
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <optional>

#include "renderer/base/error.h"
#include "renderer/commands/command.h"
#include "renderer/commands/evaluation_table.h"
#include "renderer/commands/interrupt.h"
#include "renderer/commands/judged_blocks.h"
#include "renderer/commands/train_options.h"
#include "renderer/commands/training_printer.h"
#include "renderer/output/file_io.h"
#include "stopping/base/checksum.h"
#include "stopping/base/parallel.h"
#include "stopping/base/state.h"
#include "stopping/learning/block_split.h"
#include "stopping/learning/simulation.h"

namespace lull {

namespace {

using Clock = std::chrono::steady_clock;
using Bytes = std::vector<std::byte>;

constexpr uint32_t checkpointTag = 0x3143524c;  // "LRC1"

// Keeps the states of the trainings of one command, finished ones first, in a file.
class Checkpoint {
  public:
    // An empty path stands for no file; `interval` seconds are between two writings of it.
    Checkpoint(const std::string& path, double interval) : path(path), interval(interval) {}

    void Read() {
        std::ifstream file(path, std::ios::binary);
        if (!file) throw Error(path + ": there is no checkpoint to resume from");
        const std::string text{std::istreambuf_iterator<char>(file), {}};
        StateReader reader(std::as_bytes(std::span(text)));
        reader.Expect(checkpointTag);
        while (reader.Left() > 0) {
            const uint64_t size = reader.Get<uint64_t>();
            if (size > reader.Left()) throw Error(path + ": the checkpoint is cut short");
            reader.GetAll(std::span(states.emplace_back(size)));
        }
    }
    void Set(size_t training, Bytes state) {
        states.resize(std::max(states.size(), training + 1));
        states[training] = std::move(state);
    }
    const Bytes* Find(size_t training) const {
        return training < states.size() ? &states[training] : nullptr;
    }
    bool IsDue() const { return !path.empty() && Clock::now() > written + interval; }
    void Write() {
        if (path.empty()) return;
        StateWriter writer;
        writer.Put(checkpointTag);
        for (const Bytes& state : states) {
            writer.Put(uint64_t(state.size()));
            writer.PutAll(std::span<const std::byte>(state));
        }
        WriteFileAtomically(path, writer.bytes);
        written = Clock::now();
    }
    void Remove() {
        if (!path.empty()) std::filesystem::remove(path);
    }
    const std::string& Path() const { return path; }

  private:
    std::string path;
    std::chrono::duration<double> interval;
    std::vector<Bytes> states;
    Clock::time_point written = Clock::now();
};

void CheckSpacing(const ModelSettings& settings, int passSpp) {
    for (const int spp : {settings.n, settings.voteSpacing})
        if (spp % passSpp != 0)
            throw Error(
                fmt::format("--n and --vote-spacing must be multiples of the recordings' "
                            "pass of {} spp, and {} is not",
                            passSpp, spp));
}

std::vector<BlockSplit> MakeSplits(const TrainOptions& options,
                                   std::span<const JudgedBlock> blocks) try {
    std::vector<BlockSplit> splits;
    if (options.crossValidate) splits = LeaveEachOut(blocks);
    for (BlockSplit& split : splits) split.name = "without " + split.name;
    if (options.output.empty()) return splits;
    BlockSplit split = LeaveOut(blocks, options.leaveOut);
    if (!options.split.empty()) KeepListed(ReadThresholds(options.split), &split);
    split.name = "";
    splits.push_back(std::move(split));
    return splits;
} catch (const std::invalid_argument& error) {
    throw Error(error.what());
}

// Trains a network, or goes on with it. Nothing if it was interrupted.
std::optional<Network> Train(const TrainOptions& options, const BlockSplit& split, size_t index,
                             Checkpoint* checkpoint, TrainingPrinter* printer) {
    const TrainingSamples samples = MakeSamples(split.training, options.settings);
    Trainer trainer(samples, options.training);
    if (const Bytes* state = checkpoint->Find(index)) try {
            trainer.Restore(*state);
        } catch (const std::runtime_error& error) {
            throw Error(checkpoint->Path() + ": " + error.what());
        }
    const bool isNew = !trainer.IsDone();
    if (isNew) {
        if (!options.quiet)
            fmt::print(stderr, "lull: {}{} windows of {} blocks to train on, {:.1f}% noisy\n",
                       split.name.empty() ? "" : split.name + ": ", samples.Count(),
                       split.training.size(),
                       100.0 * double(std::ranges::count(samples.noisy, char(1))) /
                           double(samples.Count()));
        printer->Begin(split.name, trainer.Progress());
    }
    while (!trainer.IsDone() && !Interrupted()) {
        trainer.Step();
        if (printer->IsDue()) printer->Print(trainer.Progress());
        if (checkpoint->IsDue()) {
            checkpoint->Set(index, trainer.Save());
            checkpoint->Write();
        }
    }
    if (isNew) printer->Finish(trainer.Progress());
    checkpoint->Set(index, trainer.Save());
    if (!trainer.IsDone()) return {};
    return trainer.Result();
}

// Adds what a network does to blocks.
void AddOutcomes(const Network& network, const ModelSettings& settings,
                 std::span<const JudgedBlock> blocks, std::vector<ViewpointOutcome>* viewpoints) {
    const Model model{network, settings, ""};
    const auto simulator = [&](const JudgedBlock& block) { return SimulateLearned(block, model); };
    for (ViewpointOutcome& viewpoint : Simulate(blocks, simulator, ""))
        viewpoints->push_back(std::move(viewpoint));
}

std::string FileText(const std::string& path) {
    return std::filesystem::path(path).filename().string() + " " + FileChecksum(path);
}

template <typename T>
std::string ListText(const std::vector<T>& list) {
    std::string text;
    for (const T& item : list) text += fmt::format("{}{}", text.empty() ? "" : ",", item);
    return text.empty() ? "none" : text;
}

std::string BlocksText(std::span<const JudgedBlock> blocks) {
    std::map<std::string, std::string> viewpoints;
    for (const JudgedBlock& block : blocks)
        viewpoints[block.viewpoint] += fmt::format(" {}", block.block);
    std::string text;
    for (const auto& [name, numbers] : viewpoints)
        text += fmt::format("{}{}:{}", text.empty() ? "" : "\n", name, numbers);
    return text.empty() ? "none" : text;
}

std::string JudgementText(const std::vector<ViewpointOutcome>& viewpoints,
                          const JudgeOptions& options) {
    const Judgement j = Judge(viewpoints, options);
    return fmt::format("critical error at {:g} %: {:.2f} %, mean error {:.0f} spp, AUC {:.4f}",
                       options.margins.at(0), 100 * j.criticalErrors.at(0), j.absoluteError,
                       j.auc.value_or(0.5));
}

// Says what a model was trained on; without the date, so that the same training gives the same
// bytes.
std::map<std::string, std::string> MakeRecord(const TrainOptions& options,
                                              const BlockSplit& split) {
    const TrainingOptions& t = options.training;
    std::string files;
    for (const std::string& path : options.datasets)
        files += (files.empty() ? "" : "\n") + FileText(path);
    return {{"version", LULL_VERSION},
            {"datasets", files},
            {"human", FileText(options.human)},
            {"training_blocks", BlocksText(split.training)},
            {"test_blocks", BlocksText(split.test)},
            {"units", ListText(t.units)},
            {"dense", ListText(t.dense)},
            {"dropout", fmt::format("{}", t.dropout)},
            {"learning_rate", fmt::format("{}", t.learningRate)},
            {"batch", fmt::format("{}", t.batch)},
            {"epochs", fmt::format("{}", t.epochs)},
            {"noisy_weight", fmt::format("{}", t.noisyWeight)},
            {"seed", fmt::format("{}", t.seed)},
            {"augment", t.augment ? "1" : "0"},
            {"balance_viewpoints", t.balanceViewpoints ? "1" : "0"},
            {"balance_classes", t.balanceClasses ? "1" : "0"}};
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
    Checkpoint checkpoint(options.output.empty() ? "" : options.output + ".checkpoint",
                          options.checkpointInterval);
    if (options.resume) checkpoint.Read();
    TrainingPrinter printer(options.jsonProgress    ? ProgressStyle::Json
                            : options.quiet         ? ProgressStyle::Silent
                            : isatty(STDERR_FILENO) ? ProgressStyle::Line
                                                    : ProgressStyle::Plain,
                            stderr);
    CatchInterrupts();

    const JudgeOptions judge{.grid = options.settings.n};
    std::vector<JudgedRule> rules;
    if (options.crossValidate) rules.push_back({.name = "each viewpoint left out"});
    std::optional<Network> network;
    for (size_t i = 0; i < splits.size(); ++i) {
        network = Train(options, splits[i], i, &checkpoint, &printer);
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
    if (!options.output.empty()) {
        std::map<std::string, std::string> record = MakeRecord(options, splits.back());
        for (const JudgedRule& rule : rules)
            record["judged on " + rule.name] = JudgementText(rule.viewpoints, judge);
        WriteModel(options.output, *network, options.settings, record);
        checkpoint.Remove();
    }
    PrintEvaluation(stdout, rules, judge, true);
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
            RunWithThreads(options->threads, [&] { code = RunTrain(*options); });
            return code;
        };
    });
}

}  // namespace lull
