#include "renderer/commands/search.h"

#include <fmt/format.h>

#include <chrono>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <limits>

#include "renderer/base/error.h"
#include "renderer/commands/interrupt.h"
#include "renderer/commands/judged_blocks.h"
#include "renderer/commands/training_run.h"
#include "renderer/output/file_io.h"
#include "stopping/learning/search.h"

namespace lull {

namespace {

using Clock = std::chrono::steady_clock;

double SecondsSince(Clock::time_point start) {
    return std::chrono::duration<double>(Clock::now() - start).count();
}

// Holds a combination that is ready to be trained.
struct Trial {
    std::vector<std::string> values;
    TrainOptions options;
    std::vector<BlockSplit> splits;
};

TrainOptions OptionsAt(const TrainOptions& options, std::span<const SearchAxis> axes,
                       const std::vector<std::string>& values) {
    std::vector<OptionValue> set;
    for (size_t i = 0; i < axes.size(); ++i) set.push_back({axes[i].option, values[i]});
    TrainOptions changed = options;
    SetTrainOptions(set, &changed);
    return changed;
}

// Checks each value by itself, so that an error can name its line.
void CheckGrid(const TrainOptions& options, std::span<const SearchAxis> axes) {
    for (const SearchAxis& axis : axes)
        for (const std::string& value : axis.values) try {
                OptionsAt(options, {&axis, 1}, {value});
            } catch (const std::invalid_argument& error) {
                throw Error(fmt::format("{}:{}: {} {}: {}", options.search, axis.line, axis.option,
                                        value, error.what()));
            }
}

std::string NameOf(std::span<const SearchAxis> axes, const std::vector<std::string>& values) {
    std::string name;
    for (size_t i = 0; i < axes.size(); ++i)
        name += fmt::format("{}{} {}", i > 0 ? ", " : "", axes[i].option, values[i]);
    return name;
}

// Makes all combinations, and finds out now whether one of them cannot be trained. All are trained
// and judged on the same blocks, or their figures could not be compared.
std::vector<Trial> MakeTrials(const TrainOptions& options, std::span<const SearchAxis> axes,
                              const std::vector<JudgedBlock>& judged) {
    std::vector<Trial> trials(CombinationCount(axes));
    std::vector<JudgedBlock> blocks = judged;
    const auto each = [&](auto&& work) {
        for (size_t i = 0; i < trials.size(); ++i) try {
                trials[i].values = CombinationAt(axes, i);
                work(trials[i]);
            } catch (const std::exception& error) {
                throw Error(fmt::format("{}: {}: {}", options.search,
                                        NameOf(axes, trials[i].values), error.what()));
            }
    };
    each([&](Trial& trial) {
        trial.options = OptionsAt(options, axes, trial.values);
        blocks = KeepRecorded(blocks, trial.options.settings);
    });
    if (blocks.empty()) throw Error("no block was recorded with attributes26");
    if (blocks.size() < judged.size())
        fmt::print(stderr, "lull: {} of {} blocks were recorded without attributes26\n",
                   judged.size() - blocks.size(), judged.size());
    each([&](Trial& trial) {
        CheckSpacing(trial.options.settings, blocks.front().passSpp);
        MeasuresOf(*blocks.front().recording, 0, trial.options.settings);
        trial.splits = MakeSplits(trial.options, blocks);
    });
    return trials;
}

// Says what everything is learned from, and with which options that no axis may change.
std::string DataText(const TrainOptions& options, const Trial& first) {
    std::string text;
    for (const auto& [name, value] : MakeRecord(options, first.splits.front()))
        text += name + "=" + value + "\n";
    const ModelSettings& s = options.settings;
    return text + fmt::format("{} {} {} {} {} {} {} {} {}", s.k, s.n, s.m, FeatureNames(s.features),
                              PoolNames(s.pools), s.snorm, s.bnorm, s.votes, s.voteSpacing);
}

// Shows how far the search is, and how long it will take.
class SearchPrinter {
  public:
    SearchPrinter(ProgressStyle style, std::vector<double> costs)
        : style(style), costs(std::move(costs)) {}

    bool IsDue() const {
        return style != ProgressStyle::Silent && SecondsSince(start) >= nextReport;
    }
    // `seconds` are those of the combinations that are done; of the one under way, `share` is done
    // and took `now` seconds.
    void Print(const std::string& name, std::span<const double> seconds, double share, double now) {
        nextReport = SecondsSince(start) + (style == ProgressStyle::Plain ? 30 : 0.25);
        std::vector<double> all = costs, taken(seconds.begin(), seconds.end());
        if (taken.size() < all.size() && share > 0) {  // count a part as a combination of its own
            const double part = all[taken.size()] * share;
            all[taken.size()] -= part;
            all.insert(all.begin() + ptrdiff_t(taken.size()), part);
            taken.push_back(now);
        }
        const double left = SecondsLeft(all, taken);
        if (style == ProgressStyle::Json)
            fmt::print(stderr,
                       R"({{"combination":{},"combinations":{},"remainingSeconds":{:.1f}}})"
                       "\n",
                       seconds.size() + 1, costs.size(), left);
        else
            fmt::print(stderr, "{}{}/{}  {}  {} left{}", style == ProgressStyle::Line ? "\r" : "",
                       std::min(seconds.size() + 1, costs.size()), costs.size(), name,
                       FormatDuration(left), style == ProgressStyle::Line ? "\x1b[K" : "\n");
        std::fflush(stderr);
    }
    void Finish() const {
        if (style == ProgressStyle::Line) fmt::print(stderr, "\n");
    }

  private:
    ProgressStyle style;
    std::vector<double> costs;
    Clock::time_point start = Clock::now();
    double nextReport = 0;
};

// Leaves only verdicts on what the network was shown: AUC and accuracy are to be those of its
// answers, however far apart these are.
void KeepAnswers(std::vector<ViewpointOutcome>* viewpoints) {
    for (ViewpointOutcome& viewpoint : *viewpoints)
        for (BlockOutcome& block : viewpoint.blocks)
            std::erase_if(block.outcome.verdicts,
                          [](const Verdict& v) { return !std::isfinite(v.score); });
}

// Trains and judges a combination. Nothing if it was interrupted. `onStep` is told how many of its
// trainings are done, and of the one under way.
std::optional<SearchResult> Try(const Trial& trial, TrainingCheckpoint* checkpoint,
                                const std::function<void(size_t done, const Trainer&)>& onStep) {
    std::vector<ViewpointOutcome> training, test;
    for (size_t i = 0; i < trial.splits.size(); ++i) {
        const BlockSplit& split = trial.splits[i];
        const TrainingEvents events = {
            .begin = [](const TrainingSamples&, const TrainingProgress&) {},
            .step = [&](const Trainer& trainer) { onStep(i, trainer); },
            .end = [](const TrainingProgress&) {}};
        const std::optional<Network> network =
            TrainNetwork(trial.options, split, i, checkpoint, events);
        if (!network) return {};
        AddOutcomes(*network, trial.options.settings, split.training, &training);
        AddOutcomes(*network, trial.options.settings, split.test, &test);
    }
    KeepAnswers(&training);
    KeepAnswers(&test);
    const JudgeOptions judge{.grid = trial.options.settings.n, .margins = {2}};
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

std::string WithExtension(const std::string& file, const char* extension) {
    return std::filesystem::path(file).replace_extension(extension).string();
}

// Keeps the results so far: the tables, and the file that the search goes on from.
void WriteResults(const TrainOptions& options, std::span<const SearchAxis> axes,
                  const std::string& data, const std::vector<SearchResult>& results) {
    std::vector<SearchResult> ranked = results;
    RankResults(&ranked);
    WriteFileAtomically(options.csv, SearchCsv(axes, ranked));
    WriteFileAtomically(WithExtension(options.csv, ".md"), SearchMarkdown(axes, ranked));
    WriteFileAtomically(options.csv + ".checkpoint", SaveResults(data, results));
}

std::vector<SearchResult> ReadResults(const std::string& file, const std::string& data) try {
    std::ifstream in(file, std::ios::binary);
    if (!in) throw Error("there is no checkpoint to resume from");
    const std::string text{std::istreambuf_iterator<char>(in), {}};
    return RestoreResults(std::as_bytes(std::span(text)), data);
} catch (const std::runtime_error& error) {
    throw Error(file + ": " + error.what());
}

}  // namespace

ExitCode RunSearch(const TrainOptions& options) {
    const std::vector<SearchAxis> axes = ReadGrid(options.search);
    const std::string table = WithExtension(options.csv, ".md");
    if (table == options.csv)
        throw Error("--csv " + options.csv + ": is the Markdown table's name");
    CheckWritable(options.csv);
    CheckWritable(table);
    CheckGrid(options, axes);
    const std::vector<ViewpointRecording> viewpoints = ReadDatasets(options.datasets);
    const std::vector<JudgedBlock> judged =
        ReadJudgedBlocks(viewpoints, options.human, options.without);
    const std::vector<Trial> trials = MakeTrials(options, axes, judged);

    const std::string data = DataText(options, trials.front());
    std::vector<SearchResult> known;
    if (options.resume) known = ReadResults(options.csv + ".checkpoint", data);
    TrainingCheckpoint checkpoint(options.csv + ".training.checkpoint", options.checkpointInterval);
    if (options.resume && std::filesystem::exists(checkpoint.Path())) checkpoint.Read();
    CatchInterrupts();

    std::vector<double> costs, seconds;
    for (const Trial& trial : trials)
        costs.push_back(SearchCost(trial.options.settings, trial.options.training, trial.splits));
    SearchPrinter printer(StyleOf(options), costs);
    std::vector<SearchResult> results;
    for (const Trial& trial : trials) {
        const auto old = std::ranges::find(known, trial.values, &SearchResult::values);
        if (old != known.end()) {
            results.push_back(*old);
            seconds.push_back(old->seconds);
            continue;
        }
        const Clock::time_point start = Clock::now();
        const std::string name = NameOf(axes, trial.values);
        const auto onStep = [&](size_t done, const Trainer& trainer) {
            if (!printer.IsDue()) return;
            const TrainingProgress p = trainer.Progress();
            const double share = double(p.samples) / double(p.allSamples);
            printer.Print(name, seconds, (double(done) + share) / double(trial.splits.size()),
                          SecondsSince(start));
        };
        std::optional<SearchResult> result;
        try {
            result = Try(trial, &checkpoint, onStep);
        } catch (const Error&) {
            throw;
        } catch (const std::exception& error) {  // the training has diverged, or has no samples
            fmt::print(stderr, "lull: {}: {}\n", name, error.what());
            result = NothingLearned(trial.values);
        }
        if (!result) {
            checkpoint.Write();
            WriteResults(options, axes, data, results);
            printer.Finish();
            fmt::print(stderr, "lull: interrupted; --resume goes on from {}.checkpoint\n",
                       options.csv);
            return kInterrupted;
        }
        result->seconds = SecondsSince(start);
        seconds.push_back(result->seconds);
        results.push_back(std::move(*result));
        checkpoint.Remove();
        WriteResults(options, axes, data, results);
    }
    printer.Finish();
    std::filesystem::remove(options.csv + ".checkpoint");
    RankResults(&results);
    fmt::print("{}", SearchMarkdown(axes, results));
    fmt::print("{}\n{}\n", options.csv, table);
    return kDone;
}

}  // namespace lull
