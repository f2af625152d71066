// `lull evaluate`: judges stopping rules by the thresholds of people.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <iterator>

#include "renderer/commands/command.h"
#include "renderer/commands/render_settings.h"
#include "renderer/files/file_io.h"
#include "renderer/lab/commands/lab_options.h"
#include "renderer/lab/commands/tables.h"
#include "stopping/lab/evaluation/evaluated_rules.h"
#include "stopping/lab/recordings/labelled_blocks.h"
#include "stopping/rules/rule_table.h"

namespace lull {

template <>
struct EnumNames<ChooseBy> {
    static constexpr std::pair<ChooseBy, const char*> all[] = {
        {ChooseBy::AbsoluteError, "error"}, {ChooseBy::CriticalError, "critical"}};
};

}  // namespace lull

namespace lull::evaluate {

namespace {

// Those with an effect on an evaluation by single answers.
constexpr const char* kOptionsOfAnswers[] = {"DATASET.h5", "--images",  "--block",   "--answers",
                                             "--stop",     "--caution", "--quality", "--without",
                                             "--brief",    "--csv"};

struct Options {
    std::vector<std::string> datasets, images, predicted, rules, without;
    int blockSize = 200;  // pixels a side, of images
    std::string human, answers, csv, blocks, curves;
    std::string split;  // the file that lists the blocks of a training; empty: all are judged
    bool rivals = false, constants = false, brief = false;
    ChooseBy chooseBy = ChooseBy::AbsoluteError;
    ScoreOptions scoring;
    double caution = 1;
};

constexpr const char* kFooter =
    R"(Without data sets, the thresholds of --predicted are evaluated on all viewpoints that both files
have. With data sets (see lull record), only their blocks are evaluated, and rules run on the
recordings, without rendering: every pass up to 400 spp, every second after.
--images DIR does the same on another renderer's images, as lull record --images would record
them. Rules that need a half buffer (lnoise, dammertz, cycles, luxtile) cannot be run on images alone.

--stop takes the rules of lull render. --rivals runs the rules with one setting, each with the best
setting of the other viewpoints (leave one out), which is in the column "setting"; the row of all
viewpoints has the best one for all of them.

Columns:
  views   number of viewpoints, and of their
  blocks  evaluated blocks
  seen    blocks that the model was trained on: figures of these do not show how it does on others
  open    recordings that ended, before 10,000 spp, when the rule had not stopped the block. Such
          rules have two rows: "at least", with these blocks stopped at the ends, which is a lower
          bound of the error if observers wanted no more; and "extended", with recordings
          extrapolated by the laws of their own noise and entropies. Predicted thresholds are used
          unchanged, and clipped to the ends in a separate row.
  ceM     critical error at a margin of M %: the fraction of spp at which the decision to stop or
          continue contradicts the observers, in %
  95 %    range of the first ceM in 95 of 100 draws of viewpoints, and of blocks in them, with
          replacement; with few viewpoints too narrow
  error   mean distance from the human threshold, in spp, and in % of 10,000 spp
  early   % of the blocks that stop below 80 % of the human threshold
  late    % of the blocks that stop above 125 % of it
  acc     accuracy of the decisions (noisy or not, by block and spp) in %, classes balanced
  auc     area under their ROC curve in %, by the number that the rule compares; for rules
          without one (fixed, thresholds, cycles) by stop / spp
  within  rank correlation of stops and human thresholds of the blocks of a viewpoint, and
  between of the means of the viewpoints; "-" where all are the same, or fewer than three
All are means over the viewpoints, but acc and auc are of all decisions together.

--constants adds rules that stop all blocks of a viewpoint at one spp: the best one for this
viewpoint ("known"), for the others, and for all viewpoints. A rule shows skill by block only where
it has a lower error than the known constant.

--split paper:FILE evaluates only blocks that FILE does not list: a row NAME;b0;b1;... has the
training blocks of a viewpoint (lull train --split).

--curves writes the number of each --stop rule over the samples of each block, with human thresholds
and stops (Buisine et al. 2021, Fig. 13).

--answers evaluates --stop rules by observers' single answers instead, on data sets of one viewpoint.
The file has a line block,spp,noise_seen and then an answer a line: blocks row by row from 0, the
spp of the image that was shown, 1 where noise was seen. Two more columns, observer,track, identify
the steps of one adjustment (lull study --collect): the answers of a track count as one. All rules
are evaluated on the same answers.
  loglik  log likelihood of the answers if the probability of seeing noise is a probit in the log of
          the rule's number (of its odds, for a network), with a location and a slope to be fitted
  share   explained fraction in %: 0 for one threshold for all blocks, 100 for one per block, both
          with one scatter in log spp
  auc     area under the ROC curve in %, of the number
  early   % of the blocks that stop below 80 % of the fitted threshold of the block, where noise is
  late    seen half of the time, and above 125 % of it; level: mean stop / threshold (geometric)
  open    stops beyond recordings, which are extrapolated

Examples:
  lull evaluate --human human.csv --predicted predicted.csv --grid 40
  lull evaluate data.h5 more.h5 --human human.csv --stop lnoise:0.5 --stop learned:model.h5
  lull evaluate data.h5 more.h5 --human human.csv --rivals --predicted predicted.csv --brief
  lull evaluate --images images/kitchen --human human.csv --stop learned --stop learned:paper
  lull evaluate data.h5 --human human.csv --stop learned:own.h5 --split paper:training-blocks.csv
  lull evaluate data.h5 --human human.csv --stop learned:paper --curves c.csv
  lull evaluate data.h5 --answers answers.csv --stop entropy --stop learned

Exit codes: 0 success, 1 input or environment error, 2 usage error.)";

void AddCriticalErrorOptions(CLI::App& app, ScoreOptions* score) {
    AddOption(app, kOptions, "--grid", &score->grid,
              "Count the decisions of critical errors every N spp", "N", Between(1, kMostShownSpp));
    AddOption(app, kOptions, "--margins", &score->margins,
              "Set the margins of the critical error, in %", "M,M,...", Between(0.0, 100.0))
        ->delimiter(',')
        ->default_str("2,6,10");
}

void AddOptions(CLI::App& app, Options* o) {
    app.add_option("DATASET.h5", o->datasets, "Data sets to run rules on")
        ->check(CLI::ExistingFile);
    AddImagesOptions(app, &o->images, &o->blockSize);
    auto* human = AddOption(app, kOptions, "--human", &o->human, "Read human thresholds", "H.csv",
                            CLI::ExistingFile);
    AddOption(app, kOptions, "--answers", &o->answers,
              "Read the single answers of observers, instead of thresholds", "A.csv",
              CLI::ExistingFile)
        ->excludes(human);
    AddList(app, "--predicted", &o->predicted, "Evaluate these thresholds; can be given again")
        ->check(CLI::ExistingFile)
        ->type_name("P.csv");
    AddList(app, "--stop", &o->rules, "Evaluate this rule; can be given again")->type_name("RULE");
    AddCautionOptions(app, kOptions, &o->caution);
    app.add_flag(
        "--rivals", o->rivals,
        "Evaluate the baselines, which have one setting:\n" + RuleNames([](const RuleEntry& rule) {
            return FindRecordedRule(rule.name)->largest > 0;
        }));
    app.add_flag("--constants", o->constants, "Evaluate constant spp, too");
    AddChoiceOption(app, "--choose-by", &o->chooseBy,
                    "Choose settings of baselines by the least error, or critical error at 2 %");
    AddList(app, "--without", &o->without, "Leave out this viewpoint; can be given again");
    AddCriticalErrorOptions(app, &o->scoring);
    app.add_flag("--brief", o->brief, "Print no tables of single viewpoints");
    app.add_option("--csv", o->csv, "Write all rows to a CSV file")->type_name("F.csv");
    app.add_option("--blocks", o->blocks, "Write the stop of each block to a CSV file")
        ->type_name("F.csv");
    AddSplitOption(app, &o->split, "Judge by the blocks alone that FILE does not list");
    app.add_option("--curves", o->curves, "Write the numbers of --stop rules to a CSV file")
        ->type_name("F.csv");
}

bool HasRecordings(const Options& options) {
    return !options.datasets.empty() || !options.images.empty();
}

std::vector<EvaluatedRule> EvaluateFiles(const Options& options) {
    const std::vector<ThresholdsRow> people = ReadHumanThresholds(options.human, options.without);
    std::vector<EvaluatedRule> rules;
    for (const std::string& path : options.predicted)
        rules.push_back(
            EvaluateThresholds(path, options.human, people, options.scoring.grid, PrintMessage));
    return rules;
}

std::vector<ViewpointRecording> ReadViewpoints(const Options& options) {
    std::vector<ViewpointRecording> viewpoints = ReadDatasets(options.datasets);
    for (const std::string& images : options.images)
        AddToDataset(RecordAndTell(FindNamedPictures(images), {.blockSize = options.blockSize}, {}),
                     &viewpoints);
    return viewpoints;
}

std::vector<LabelledBlock> BlocksToJudge(const std::vector<ViewpointRecording>& viewpoints,
                                         const Options& options) {
    std::vector<LabelledBlock> blocks =
        ReadLabelledBlocks(viewpoints, options.human, options.without, PrintMessage);
    if (options.split.empty()) return blocks;
    const std::vector<ThresholdsRow> rows = ReadThresholds(options.split);
    try {
        blocks = TestBlocks(blocks, rows);
    } catch (const std::invalid_argument& error) {
        throw Error("{}: {}", options.split, error.what());
    }
    PrintMessage(fmt::format("{} blocks that {} does not list", blocks.size(), options.split));
    return blocks;
}

std::vector<EvaluatedRule> EvaluateRecordings(const Options& options) {
    const std::vector<ViewpointRecording> viewpoints = ReadViewpoints(options);
    return EvaluateOnBlocks(BlocksToJudge(viewpoints, options),
                            {.rivals = options.rivals,
                             .chooseBy = options.chooseBy,
                             .rules = options.rules,
                             .context = {.models = ModelFolder(), .caution = options.caution},
                             .predicted = options.predicted,
                             .grid = options.scoring.grid});
}

ViewpointRecording ReadViewpoint(const Options& options) {
    std::vector<ViewpointRecording> viewpoints = ReadViewpoints(options);
    for (const std::string& name : options.without)
        if (std::erase_if(viewpoints, [&](const auto& v) { return v.name == name; }) == 0)
            throw Error("--without: there is no viewpoint '{}'", name);
    if (viewpoints.size() == 1) return std::move(viewpoints[0]);
    std::string names;
    for (const ViewpointRecording& v : viewpoints)
        names += (names.empty() ? "'" : ", '") + v.name + "'";
    throw Error(
        "--answers are to one viewpoint, but the data sets have {}; leave out others by --without",
        viewpoints.empty() ? "none" : names);
}

std::vector<NamedFile> InputsOf(const Options& options) {
    std::vector<NamedFile> inputs = {
        {"--human", options.human}, {"--answers", options.answers}, {"--split", options.split}};
    for (const std::string& file : options.datasets) inputs.push_back({"DATASET.h5", file});
    for (const std::string& file : options.predicted) inputs.push_back({"--predicted", file});
    for (const std::string& rule : options.rules) AddFileOfRule(rule, &inputs);
    return inputs;
}

void RunByAnswers(const Options& options) {
    const std::vector<SingleAnswer> answers = ReadSingleAnswers(options.answers);
    const ViewpointRecording viewpoint = ReadViewpoint(options);
    CheckBlocks(answers, viewpoint.blockCount, options.answers);
    const AnswerScores scores = EvaluateByAnswers(
        viewpoint, answers, options.rules, {.models = ModelFolder(), .caution = options.caution});
    PrintAnswerScores(stdout, scores, !options.brief);
    if (!options.csv.empty()) WriteFileAtomically(options.csv, AnswerScoresCsv(scores));
}

ExitCode RunEvaluate(const Options& options) {
    CheckOutputs(
        std::vector<NamedFile>{
            {"--csv", options.csv}, {"--blocks", options.blocks}, {"--curves", options.curves}},
        InputsOf(options));
    if (!options.answers.empty()) {
        RunByAnswers(options);
        return kDone;
    }
    std::vector<EvaluatedRule> rules =
        HasRecordings(options) ? EvaluateRecordings(options) : EvaluateFiles(options);
    if (options.constants)
        std::ranges::move(
            EvaluateConstants(rules.at(0).viewpoints, options.chooseBy, options.scoring.grid),
            std::back_inserter(rules));
    if (rules.at(0).viewpoints.size() == 1)
        PrintMessage("one viewpoint: the results do not generalise to others");
    PrintEvaluation(stdout, rules, options.scoring, !options.brief);
    if (!options.csv.empty())
        WriteFileAtomically(options.csv, EvaluationCsv(rules, options.scoring));
    if (!options.blocks.empty()) WriteFileAtomically(options.blocks, BlocksCsv(rules));
    if (!options.curves.empty()) WriteFileAtomically(options.curves, CurvesCsv(rules));
    return kDone;
}

void CheckUsage(const CLI::App& app, const Options& options) {
    const bool runs = options.rivals || !options.rules.empty();
    if (!options.answers.empty()) {
        if (!HasRecordings(options) || options.rules.empty())
            throw CLI::ValidationError("--answers",
                                       "needs DATASET.h5 or --images, and --stop for its rules");
        AllowOnly(app, kOptionsOfAnswers, "with --answers");
        return;
    }
    if (options.human.empty())
        throw CLI::ValidationError("evaluate", "needs --human, or --answers");
    if (!HasRecordings(options) && runs)
        throw CLI::ValidationError("--stop and --rivals",
                                   "need DATASET.h5 or --images to run rules on");
    if (options.rules.empty() && !options.curves.empty())
        throw CLI::ValidationError("--curves", "shows the rules of --stop");
    if (!options.split.empty() && !HasRecordings(options))
        throw CLI::ValidationError("--split", "needs DATASET.h5 or --images");
    if (!runs && options.predicted.empty())
        throw CLI::ValidationError("evaluate", "needs --predicted, --stop or --rivals");
    for (const char* option : {"--caution", "--quality"})
        if (app.count(option) > 0 && options.rules.empty())
            throw CLI::ValidationError(option, "is for the rules of --stop");
    if (app.count("--choose-by") > 0 && !options.rivals && !options.constants)
        throw CLI::ValidationError("--choose-by", "is for --rivals and --constants");
}

}  // namespace

void AddCommand(CLI::App& app, Command* command) {
    CLI::App* evaluate =
        app.add_subcommand("evaluate", "Compares stopping rules with human thresholds.");
    auto options = std::make_shared<Options>();
    AddOptions(*evaluate, options.get());
    evaluate->footer(kFooter);
    evaluate->callback([=] {
        CheckUsage(*evaluate, *options);
        *command = [=] { return RunEvaluate(*options); };
    });
}

}  // namespace lull::evaluate
