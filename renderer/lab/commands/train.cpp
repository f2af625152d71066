// `lull train`: trains a stopping rule on human thresholds.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <optional>
#include <set>
#include <sstream>
#include <stdexcept>
#include <type_traits>

#include "renderer/base/clocks.h"
#include "renderer/base/error.h"
#include "renderer/commands/command.h"
#include "renderer/commands/render_job.h"
#include "renderer/files/file_io.h"
#include "renderer/files/outputs.h"
#include "renderer/lab/commands/lab_options.h"
#include "renderer/lab/commands/tables.h"
#include "renderer/progress/progress.h"
#include "stopping/base/parallel.h"
#include "stopping/lab/recordings/labelled_blocks.h"
#include "stopping/lab/training/training_plan.h"
#include "stopping/network/model_file.h"

namespace lull::train {

namespace {

struct TrainOptions {
    TrainingPlan plan;
    std::string output, csv;
    bool resume = false;
    double checkpointInterval = 60;  // s
    int threads = 0;
    bool quiet = false, jsonProgress = false;
    bool isPreset = false;     // --preset was given
    bool listsValues = false;  // and nothing is trained: its values are listed
};

constexpr const char* kFooter =
    R"(Trains a network on data sets (see lull record) and human thresholds. The defaults make the
model `entropy`: a small LSTM network on the visible drop in SVD-entropy of a block. --preset paper
takes the configuration of Buisine et al. 2021, a larger network on windows of 8 SVD-entropies of 100
sub-blocks. Other options change either. Viewpoints are joined by name; those without thresholds are
ignored.

Features for --features (also --channels), a list with commas:
  H, H1, H2          SVD-entropies of 100 sub-blocks
  visible_drop       visible noise (1.5 to 2 times its L*), from the drop in H, of 10x10 sub-blocks
  attributes26       means and deviations of the block minus its filtered copies, for 13 filters;
                     blocks recorded without them are ignored
The same options and seed give the same weights for any number of threads. An interrupted training
with -o leaves MODEL.h5.checkpoint and continues with --resume.

--cross-validate evaluates each viewpoint by a network trained on all others. With -o, it also writes
a network trained on all viewpoints. For the columns of the tables see lull evaluate --help.

Examples:
  lull train data.h5 --human human.csv -o model.h5
  lull train data.h5 --human human.csv -o model.h5 --leave-out kitchen-view0
  lull train data.h5 --human human.csv --cross-validate --features H,visible_drop --units 16,8
  lull train data.h5 --human human.csv --cross-validate --preset paper
  lull train --preset paper

Exit codes: 0 success, 1 input or environment error, 2 usage error, 130 interrupted.)";

template <typename T>
void AddNames(CLI::App& app, const std::string& names, T (*parse)(const std::string&), T* value,
              const std::string& help, const std::string& standard) {
    app.add_option_function<std::string>(
           names,
           [=](const std::string& text) {
               try {
                   *value = parse(text);
               } catch (const std::invalid_argument& error) {
                   throw CLI::ValidationError(names, error.what());
               }
           },
           help)
        ->type_name("A,B,...")
        ->default_str(standard);
}

std::string PoolText(bool takesMean) { return takesMean ? "mean" : "none"; }
bool ParsePool(const std::string& text) {
    if (text != "mean" && text != "none")
        throw std::invalid_argument("'" + text + "' is neither mean nor none");
    return text == "mean";
}

// CLI11's own lists skip empty values, and take the arguments that follow as well.
std::vector<int> ParseUnits(const std::string& text) {
    std::vector<int> units;
    std::istringstream list(text + ",");
    for (std::string unit; std::getline(list, unit, ',');) {
        if (const std::string problem = ProblemOfNumber(unit, 1, 16384); !problem.empty())
            throw std::invalid_argument(problem);
        units.push_back(std::stoi(unit));
    }
    return units;
}

std::string DefaultNote(bool isDefault) { return isDefault ? " [the default]" : ""; }

template <typename T>
void AddNumber(CLI::App& app, const std::string& name, T* value, T least, T most,
               const std::string& help) {
    AddOption(app, kOptions, name, value, help, std::is_integral_v<T> ? "N" : "X",
              Between(least, most));
}

void AddSettings(CLI::App& app, ModelSettings* s) {
    AddNumber(app, "--k", &s->k, 1, 1000, "Set the steps of a window");
    AddNumber(app, "--n", &s->n, 1, 1000000, "Set the spp between steps");
    AddNames(app, "--features,--channels", ParseFeatures, &s->features,
             "Set the inputs of the network", FeatureNames(s->features));
    AddNames(app, "--pool", ParsePool, &s->takesMean,
             "Take the mean of the values of the sub-blocks (mean), or each value (none)",
             PoolText(s->takesMean));
    AddNames(app, "--spacing", ParseSpacing, &s->spacing,
             "Space steps n spp apart (fixed) or by --ratio (geometric)", SpacingName(s->spacing));
    AddNumber(app, "--ratio", &s->ratio, 1.1, 16.0, "Set the ratio of geometric spacing");
    NoiseVisibility* v = &s->visibility;
    AddNumber(app, "--mask", &v->mask, 1e-3, 1e9,
              "visible_drop: mask noise by detail of deviation d, as 1 / (1 + d / X)");
    AddNumber(app, "--flare", &v->flare, 0.0, 1.0,
              "visible_drop: set the light reflected by the screen, as a fraction of white");
    AddNumber(app, "--nearness", &v->nearness, 0.0, 10.0,
              "visible_drop: weigh noise by (1 - spp / 10000)^X");
    AddNumber(app, "--peak-limit", &s->peakLimit, 0.0, 100.0,
              "Do not stop blocks with this much peak noise in L*; 0: no limit");
}

void AddTraining(CLI::App& app, TrainingOptions* t) {
    AddNames(app, "--units", ParseUnits, &t->units, "Set the units of the LSTM layers",
             fmt::format("{}", fmt::join(t->units, ",")));
    app.get_option("--units")->type_name("N,N,...");
    AddNumber(app, "--dropout", &t->dropout, 0.0, 0.99,
              "Drop this fraction of each LSTM layer's inputs");
    AddOption(app, kOptions, "--learning-rate", &t->learningRate,
              "Set the learning rate of RMSprop", "X", AboveZero());
    AddNumber(app, "--epochs", &t->epochs, 1, 1000000, "Set the number of epochs");
    AddOption(app, kOptions, "--seed", &t->seed, "Seed the initial weights", "N", WholeNumber());
    app.add_flag("--balance-viewpoints,!--no-balance-viewpoints", t->balanceViewpoints,
                 "Let each viewpoint count the same, however many blocks of\nit there are" +
                     DefaultNote(t->balanceViewpoints));
    app.add_flag("--class-weights,!--no-class-weights", t->balanceClasses,
                 "Let noisy and noiseless samples count the same, as in the paper" +
                     DefaultNote(t->balanceClasses));
}

// Adds the option that sets all of a model and its training. It has to be added before those that
// change single ones: options are applied in this order.
void AddPreset(CLI::App& app, TrainingPlan* plan, bool* isGiven) {
    std::set<std::string> names;
    for (const TrainingPreset& preset : TrainingPresets()) names.insert(preset.name);
    const auto set = [plan](const std::string& name) {
        const auto preset = std::ranges::find(TrainingPresets(), name, &TrainingPreset::name);
        plan->settings = preset->settings;
        plan->training = preset->training;
    };
    const std::string& standard = TrainingPresets().front().name;
    set(standard);
    app.add_option_function<std::string>(
           "--preset",
           [=](const std::string& name) {
               set(name);
               *isGiven = true;
           },
           "Defaults of the options from --k on; without data sets, lists them")
        ->check(OneOf(names))
        ->type_name("entropy|paper")
        ->default_str(standard);
}

void AddTrainOptions(CLI::App& app, TrainOptions* o) {
    app.add_option("DATASET.h5", o->plan.datasets, "Recordings to learn from")
        ->check(CLI::ExistingFile);
    AddOption(app, kOptions, "--human", &o->plan.human, "Read human thresholds", "H.csv",
              CLI::ExistingFile);
    app.add_option("-o,--output", o->output, "Model to write")->type_name("MODEL.h5");
    AddPreset(app, &o->plan, &o->isPreset);
    AddSettings(app, &o->plan.settings);
    AddTraining(app, &o->plan.training);
    AddList(app, "--leave-out", &o->plan.leaveOut,
            "Viewpoint to judge by, not to train on; can be given again");
    AddList(app, "--together", &o->plan.together,
            "--cross-validate: leave viewpoints whose names begin so out together;\ncan be given "
            "again");
    AddList(app, "--without", &o->plan.without, "Viewpoint to ignore; can be given again");
    AddSplitOption(app, &o->plan.split,
                   "Train on the blocks that FILE lists (name;b0;b1;...),\njudge by the others");
    app.add_flag("--cross-validate", o->plan.crossValidate, "Leave each viewpoint out in turn");
    app.add_flag("--resume", o->resume, "Resume from MODEL.h5.checkpoint");
    app.add_option("--checkpoint-interval", o->checkpointInterval, "Seconds between checkpoints")
        ->check(Between(0.1, 1e6))
        ->capture_default_str();
    app.add_option("--csv", o->csv, "Write the scores to a CSV file")->type_name("F.csv");
    AddNumber(app, "--threads", &o->threads, 0, 4096, "Train on N threads; 0: one per core");
    app.add_flag("--quiet", o->quiet, "Print only warnings, errors and scores");
    app.add_flag("--json-progress", o->jsonProgress,
                 "Print events as JSON, one object per line, on stderr");
    app.footer(kFooter);
}

// Completes defaults that depend on other options. Throws CLI::ValidationError.
void CompleteTrainOptions(TrainOptions* o) {
    if (o->plan.datasets.empty() && o->isPreset) {  // which then lists its values
        o->listsValues = true;
        return;
    }
    if (o->plan.datasets.empty())
        throw CLI::ValidationError("train",
                                   "needs DATASET.h5; --preset by itself lists its values");
    if (o->plan.human.empty()) throw CLI::ValidationError("--human", "is required");
    const bool leavesOut = !o->plan.leaveOut.empty() || !o->plan.split.empty();
    if (o->output.empty() && !o->plan.crossValidate && !leavesOut)
        throw CLI::ValidationError("train",
                                   "needs -o MODEL.h5, --cross-validate, --leave-out or --split");
    if (o->resume && o->output.empty())
        throw CLI::ValidationError("--resume", "needs -o MODEL.h5, beside which the checkpoint is");
    if (o->plan.crossValidate && leavesOut)
        throw CLI::ValidationError("--cross-validate",
                                   "chooses blocks itself, without --leave-out and --split");
    TrainingPlan& plan = o->plan;
    plan.withLast = !o->output.empty() || !plan.crossValidate;
    plan.version = LULL_VERSION;
    // Recordings have every second pass, and so has a rule that votes as often as it was trained.
    plan.settings.voteSpacing = plan.settings.n;
}

std::string ValuesText(TrainingPlan plan) {
    CLI::App app;
    AddSettings(app, &plan.settings);
    AddTraining(app, &plan.training);
    std::string text;
    for (const CLI::Option* option : app.get_options())
        if (const std::string value = option->get_default_str(); !value.empty())
            text += fmt::format("{} {}\n", option->get_name(), value);
    const auto flag = [](const char* name, bool isSet) {
        return fmt::format("--{}{}\n", isSet ? "" : "no-", name);
    };
    return text + flag("balance-viewpoints", plan.training.balanceViewpoints) +
           flag("class-weights", plan.training.balanceClasses);
}

std::vector<NamedFile> InputsOf(const TrainingPlan& plan) {
    std::vector<NamedFile> inputs = {{"--human", plan.human}};
    for (const std::string& file : plan.datasets) inputs.push_back({"DATASET.h5", file});
    return inputs;
}

// Tells how far a training is: a line on a terminal, plain lines in a log, or JSON for programs.
class TrainingPrinter {
  public:
    explicit TrainingPrinter(ProgressStyle style) : style(style) {}

    void Begin(const std::string& about, const TrainingProgress& progress) {
        name = about;
        start = std::chrono::steady_clock::now();
        samplesBefore = progress.samples;
        nextReport = 0;
    }
    bool IsDue() const {
        return style != ProgressStyle::Silent && SecondsSince(start) >= nextReport;
    }
    void Print(const TrainingProgress& progress);
    void Finish(const TrainingProgress& progress);

  private:
    ProgressStyle style;
    std::string name = {};
    std::chrono::steady_clock::time_point start = {};
    int64_t samplesBefore = 0;  // of a training that is resumed
    double nextReport = 0;      // seconds since the start
};

void TrainingPrinter::Print(const TrainingProgress& p) {
    if (style == ProgressStyle::Silent) return;
    const double seconds = SecondsSince(start);
    const double rate = seconds > 0 ? double(p.samples - samplesBefore) / seconds : 0;
    const double left = rate > 0 ? double(p.allSamples - p.samples) / rate : 0;
    nextReport = seconds + (style == ProgressStyle::Plain ? 30 : 0.25);
    const std::string text =
        style == ProgressStyle::Json
            ? fmt::format(
                  R"({{"training":"{}","epoch":{},"epochs":{},"samples":{},"allSamples":{},)"
                  R"("loss":{:.6f},"auc":{:.6f},"samplesPerSecond":{:.1f},)"
                  R"("remainingSeconds":{:.1f}}})",
                  name, p.epoch, p.epochs, p.samples, p.allSamples, p.loss, p.auc, rate, left)
            : fmt::format("{}{}epoch {}/{}  loss {:.4f}  AUC {:.3f}  {} samples/s  {} left", name,
                          name.empty() ? "" : "  ", p.epoch, p.epochs, p.loss, p.auc,
                          FormatCount(rate), FormatDuration(left));
    PrintReport(text, style, stderr);
}

void TrainingPrinter::Finish(const TrainingProgress& progress) {
    Print(progress);
    if (style == ProgressStyle::Line) PrintTo(stderr, "\n");
    std::fflush(stderr);
}

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
    TrainingPrinter printer(StyleOfReports(options.jsonProgress, options.quiet));
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
