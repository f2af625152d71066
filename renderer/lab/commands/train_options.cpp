#include "renderer/lab/commands/train_options.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <charconv>
#include <set>
#include <stdexcept>

#include "renderer/commands/command.h"
#include "renderer/lab/commands/lab_options.h"
#include "stopping/lab/training/training_plan.h"

namespace lull::train {

namespace {

constexpr const char* kFooter =
    R"(Trains a network on data sets (see lull record) and human thresholds. The defaults make the
model `entropy`: a small LSTM network on the visible drop in SVD-entropy of a block. --preset paper
takes the configuration of Buisine et al. 2021, a larger network on windows of 8 SVD-entropies of 100
sub-blocks. Other options change either. Viewpoints are joined by name; those without thresholds are
ignored.

Features for --features (also --channels), a list with commas:
  H, H1, H2          SVD-entropies of m sub-blocks (H1 and H2 for m = 100 only)
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

bool ParseUnits(const std::string& text, std::vector<int>* units) {
    units->clear();
    const char* at = text.data();
    const char* const end = at + text.size();
    while (true) {
        int value = 0;
        const auto [next, error] = std::from_chars(at, end, value);
        if (error != std::errc() || value < 1 || value > 16384) return false;
        units->push_back(value);
        if (next == end) return true;
        if (*next != ',') return false;
        at = next + 1;
    }
}

std::string UnitsText(const std::vector<int>& units) {
    std::string text;
    for (const int n : units) text.append(text.empty() ? "" : ",").append(std::to_string(n));
    return text;
}

void AddUnits(CLI::App& app, std::vector<int>* units) {
    app.add_option_function<std::string>(
           "--units",
           [=](const std::string& text) {
               if (!ParseUnits(text, units))
                   throw CLI::ValidationError("--units", text + " is not a list as 512,128,32");
           },
           "Set the units of the LSTM layers")
        ->type_name("N,N,...")
        ->default_str(UnitsText(*units));
}

// Adds an option whose text is parsed by a function that throws std::invalid_argument.
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

std::string DefaultNote(bool isDefault) { return isDefault ? " [the default]" : ""; }

template <typename T>
void AddNumber(CLI::App& app, const std::string& name, T* value, T least, T most,
               const std::string& help) {
    app.add_option(name, *value, help)
        ->check(Between(least, most))
        ->type_name("N")
        ->capture_default_str();
}

void AddReal(CLI::App& app, const std::string& name, double* value, double least, double most,
             const std::string& help) {
    app.add_option(name, *value, help)
        ->check(Between(least, most))
        ->type_name("X")
        ->capture_default_str();
}

void AddSettings(CLI::App& app, ModelSettings* s) {
    AddNumber(app, "--k", &s->k, 1, 1000, "Set the steps of a window");
    AddNumber(app, "--n", &s->n, 1, 1000000, "Set the spp between steps");
    app.add_option("--m", s->m, "Set the number of sub-blocks of entropies")
        ->check(OneOf(std::set{4, 25, 100, 400}))
        ->type_name("4|25|100|400")
        ->capture_default_str();
    AddNames(app, "--features,--channels", ParseFeatures, &s->features,
             "Set the inputs of the network", FeatureNames(s->features));
    AddNames(app, "--pool", ParsePool, &s->takesMean,
             "Take the mean of the values of the sub-blocks (mean), or each value (none)",
             PoolText(s->takesMean));
    app.add_flag("--snorm,!--no-snorm", s->snorm,
                 "Normalise entropies and attributes26 over the window" + DefaultNote(s->snorm));
    AddNames(app, "--spacing", ParseSpacing, &s->spacing,
             "Space steps n spp apart (fixed) or by --ratio (geometric)", SpacingName(s->spacing));
    AddReal(app, "--ratio", &s->ratio, 1.1, 16.0, "Set the ratio of geometric spacing");
    NoiseVisibility* v = &s->visibility;
    AddReal(app, "--mask", &v->mask, 1e-3, 1e9,
            "visible_drop: mask noise by detail of deviation d, as 1 / (1 + d / X)");
    AddReal(app, "--flare", &v->flare, 0.0, 1.0,
            "visible_drop: set the light reflected by the screen, as a fraction of white");
    AddNumber(app, "--reference", &v->reference, 1, 1 << 30,
              "visible_drop: set the spp of the observers' reference");
    AddReal(app, "--nearness", &v->nearness, 0.0, 10.0,
            "visible_drop: weigh noise by (1 - spp / N)^X, N: --reference");
    AddReal(app, "--peak-limit", &s->peakLimit, 0.0, 100.0,
            "Do not stop blocks with this much peak noise in L*; 0: no limit");
    AddNumber(app, "--votes", &s->votes, 1, 1000, "Stop after N consecutive votes");
    app.add_option("--vote-spacing", s->voteSpacing, "Vote every N spp [n]")
        ->check(Between(1, 1000000))
        ->type_name("N");
}

void AddTraining(CLI::App& app, TrainingOptions* t) {
    AddUnits(app, &t->units);
    app.add_option("--dropout", t->dropout, "Drop this fraction of each LSTM layer's inputs")
        ->check(Between(0.0, 0.99))
        ->type_name("X")
        ->capture_default_str();
    app.add_option("--learning-rate", t->learningRate, "Set the learning rate of RMSprop")
        ->check(AboveZero())
        ->type_name("X")
        ->capture_default_str();
    AddNumber(app, "--batch", &t->batch, 1, 1 << 20, "Set the samples per batch");
    AddNumber(app, "--epochs", &t->epochs, 1, 1000000, "Set the number of epochs");
    app.add_option("--seed", t->seed, "Seed the initial weights")
        ->check(WholeNumber())
        ->type_name("N")
        ->capture_default_str();
    app.add_flag("--balance-viewpoints,!--no-balance-viewpoints", t->balanceViewpoints,
                 "Let each viewpoint count the same, however many blocks of\nit there are" +
                     DefaultNote(t->balanceViewpoints));
    app.add_flag("--class-weights,!--no-class-weights", t->balanceClasses,
                 "Let noisy and noiseless samples count the same, as in the paper" +
                     DefaultNote(t->balanceClasses));
}

void AddList(CLI::App& app, const std::string& name, std::vector<std::string>* list,
             const std::string& help) {
    app.add_option(name, *list, help)
        ->expected(1)
        ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll)
        ->type_name("NAME");
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

}  // namespace

void AddTrainOptions(CLI::App& app, TrainOptions* o) {
    app.add_option("DATASET.h5", o->plan.datasets, "Recordings to learn from")
        ->check(CLI::ExistingFile);
    app.add_option("--human", o->plan.human, "Read human thresholds")
        ->check(CLI::ExistingFile)
        ->type_name("H.csv");
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
    app.add_flag("--resume", o->resume, "Go on from MODEL.h5.checkpoint");
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
    if (plan.settings.voteSpacing == 0) plan.settings.voteSpacing = plan.settings.n;
}

std::string ValuesText(const TrainingPlan& plan) {
    const ModelSettings& s = plan.settings;
    const TrainingOptions& t = plan.training;
    const auto flag = [](const char* name, bool isSet) {
        return fmt::format("--{}{}\n", isSet ? "" : "no-", name);
    };
    std::string text = fmt::format("--k {}\n--n {}\n--m {}\n--features {}\n--pool {}\n", s.k, s.n,
                                   s.m, FeatureNames(s.features), PoolText(s.takesMean));
    text += flag("snorm", s.snorm);
    text += fmt::format("--spacing {}\n", SpacingName(s.spacing));
    if (s.spacing == Spacing::Geometric) text += fmt::format("--ratio {:g}\n", s.ratio);
    if (Needs(s, Feature::VisibleDrop))
        text += fmt::format("--mask {:g}\n--flare {:g}\n--reference {}\n--nearness {:g}\n",
                            s.visibility.mask, s.visibility.flare, s.visibility.reference,
                            s.visibility.nearness);
    text += fmt::format("--peak-limit {:g}\n", s.peakLimit);
    text += fmt::format("--votes {}\n--vote-spacing {}\n", s.votes,
                        s.voteSpacing > 0 ? s.voteSpacing : s.n);
    text +=
        fmt::format("--units {}\n--dropout {:g}\n--learning-rate {:g}\n--batch {}\n--epochs {}\n",
                    UnitsText(t.units), t.dropout, t.learningRate, t.batch, t.epochs);
    return text + flag("balance-viewpoints", t.balanceViewpoints) +
           flag("class-weights", t.balanceClasses);
}

std::vector<NamedFile> InputsOf(const TrainingPlan& plan) {
    std::vector<NamedFile> inputs = {{"--human", plan.human}};
    for (const std::string& file : plan.datasets) inputs.push_back({"DATASET.h5", file});
    return inputs;
}

}  // namespace lull::train
