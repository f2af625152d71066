#include "renderer/lab/commands/search.h"

#include <fmt/format.h>

#include <chrono>
#include <filesystem>

#include "renderer/base/error.h"
#include "renderer/base/say.h"
#include "renderer/base/seconds_since.h"
#include "renderer/commands/interrupt.h"
#include "renderer/commands/talk.h"
#include "renderer/files/file_io.h"

namespace lull {

namespace {

using Clock = std::chrono::steady_clock;

// Shows how far the search is, and how long it will take.
class SearchPrinter {
  public:
    SearchPrinter(ProgressStyle style, std::span<const Trial> trials) : style(style) {
        for (const Trial& trial : trials)
            costs.push_back(SearchCost(trial.plan.settings, trial.plan.training, trial.splits));
    }

    bool IsDue() const {
        return style != ProgressStyle::Silent && SecondsSince(start) >= nextReport;
    }
    void Print(const SearchProgress& progress) {
        nextReport = SecondsSince(start) + (style == ProgressStyle::Plain ? 30 : 0.25);
        const size_t done = progress.seconds.size();
        std::vector<double> all = costs, taken(progress.seconds.begin(), progress.seconds.end());
        const double share = progress.Share();
        if (done < all.size() && share > 0) {  // count a part as a combination of its own
            const double part = all[taken.size()] * share;
            all[taken.size()] -= part;
            all.insert(all.begin() + ptrdiff_t(taken.size()), part);
            taken.push_back(progress.now);
        }
        const double left = SecondsLeft(all, taken);
        if (style == ProgressStyle::Json)
            Say(R"({{"combination":{},"combinations":{},"remainingSeconds":{:.1f}}})"
                "\n",
                done + 1, costs.size(), left);
        else
            Say("{}{}/{}  {}  {} left{}", style == ProgressStyle::Line ? "\r" : "",
                std::min(done + 1, costs.size()), costs.size(), progress.trial.name,
                FormatDuration(left), style == ProgressStyle::Line ? "\x1b[K" : "\n");
        std::fflush(stderr);
    }
    void Finish() const {
        if (style == ProgressStyle::Line) Say("\n");
    }

  private:
    ProgressStyle style;
    std::vector<double> costs;
    Clock::time_point start = Clock::now();
    double nextReport = 0;
};

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

}  // namespace

ExitCode RunSearch(const TrainOptions& options) {
    const TrainingPlan& plan = options.plan;
    const std::vector<SearchAxis> axes = ReadGrid(options.search);
    const std::string table = WithExtension(options.csv, ".md");
    TrainingCheckpoint checkpoint(options.csv + ".training.checkpoint", options.checkpointInterval,
                                  WriteBytes);
    std::vector<NamedFile> inputs = InputsOf(plan);
    inputs.push_back({"--search", options.search});
    CheckOutputs(std::vector<NamedFile>{{"--csv", options.csv},
                                        {"the Markdown table", table},
                                        {"the checkpoint", options.csv + ".checkpoint"},
                                        {"the checkpoint", checkpoint.Path()}},
                 inputs);
    CheckGrid(plan, options.search, axes, SetPlanOptions);
    const Talk talk{.isJson = options.jsonProgress};
    const auto note = [&](const std::string& message) { talk.Note(message); };
    const std::vector<ViewpointRecording> viewpoints = ReadDatasets(plan.datasets);
    const std::vector<Trial> trials = MakeTrials(
        plan, options.search, axes, ReadJudgedBlocks(viewpoints, plan.human, plan.without, note),
        SetPlanOptions, note);

    const std::string data = SearchDataText(plan, trials.front());
    std::vector<SearchResult> known;
    if (options.resume) known = ReadResults(options.csv + ".checkpoint", data);
    if (options.resume && std::filesystem::exists(checkpoint.Path())) checkpoint.Read();
    CatchInterrupts();

    SearchPrinter printer(StyleOf(options), trials);
    SearchOutcome outcome = RunTrials(trials, known, &checkpoint,
                                      {.step =
                                           [&](const SearchProgress& progress) {
                                               if (printer.IsDue()) printer.Print(progress);
                                           },
                                       .keep =
                                           [&](const std::vector<SearchResult>& results) {
                                               WriteResults(options, axes, data, results);
                                           },
                                       .warn = note,
                                       .isCancelled = Interrupted});
    printer.Finish();
    if (outcome.cancelled) {
        talk.Note("interrupted; --resume goes on from " + options.csv + ".checkpoint");
        return kInterrupted;
    }
    std::filesystem::remove(options.csv + ".checkpoint");
    RankResults(&outcome.results);
    fmt::print("{}", SearchMarkdown(axes, outcome.results));
    fmt::print("{}\n{}\n", options.csv, table);
    return kDone;
}

}  // namespace lull
