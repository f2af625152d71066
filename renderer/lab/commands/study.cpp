// `lull study`: observers mark visible noise, of which `--collect` computes human thresholds.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <map>
#include <sstream>

#include "renderer/base/error.h"
#include "renderer/base/memory.h"
#include "renderer/commands/command.h"
#include "renderer/commands/render_job.h"
#include "renderer/files/file_io.h"
#include "renderer/files/outputs.h"
#include "renderer/lab/commands/lab_options.h"
#include "renderer/lab/pages/comparison_page.h"
#include "renderer/lab/viewpoints/study.h"
#include "stopping/base/parallel.h"
#include "stopping/lab/observers/observers.h"

namespace lull::study {

namespace {

constexpr double kLadderRatio = 1.25;

struct Options {
    RenderSettings render;
    StudySettings study;
    std::string images;                // the folder of another renderer's pictures; empty: none
    std::vector<std::string> collect;  // files of answers; empty: a study is made
    std::string output, name;
    std::string record;             // the data set that the render is recorded to; empty: none
    std::string report, studyPage;  // of --collect; empty: none
    int levels = 0;                 // 0: as many as steps of kLadderRatio give
};

// Those with an effect on a study of another renderer's pictures, and on the collection of answers.
constexpr const char* kOptionsOfPictures[] = {
    "--images", "--name",    "--levels",  "--block", "--threads",
    "--output", "--repeats", "--catches", "--quiet", "--json-progress"};
constexpr const char* kOptionsOfAnswers[] = {"--collect", "--study", "--output",
                                             "--report",  "--quiet", "--json-progress"};

constexpr const char* kFooter =
    R"(Makes a page on which observers mark visible noise, and collects their answers.

The scene is rendered to the cap once, and each block stored at a ladder of sample counts, each level
a quarter above the last. STUDY.html opens from disk in any browser, without a network connection; an
observer ends with a small file of answers. An interrupted render leaves STUDY.html.checkpoint, from
which the same command continues. The noise is that of `lull record`, by pbrt-v3's estimator and random
sampler, unless --sampler and --estimator are given.

Image and reference are side by side: observers point where they differ, and the block gets one level
better, until both look the same (Buisine et al. 2021). Start levels differ between observers, some
blocks are asked twice, and some show the reference on both sides, to detect inattentive observers.
Observers cannot begin in a window that is too small for both images.

--collect writes, in one folder:
  HUMAN.csv             mean thresholds over observers, in the format of the published ones
  HUMAN.details.csv     of each block: the spread over observers
  HUMAN.observers.csv   of each observer: consistency, checks failed, display, distance, who was left
                        out or is in doubt, and why
  HUMAN.answers.csv     single answers with observer and adjustment (track), for `lull evaluate
                        --answers`
Damaged, foreign and contradictory files are named and left out.

Examples:
  lull study scene.pbrt -o study.html --record data.h5
  lull study scene.pbrt -o study.html --resolution 800x800 --max-spp 2000
  lull study --images images/ --name kitchen-view0 -o study.html
  lull study --collect answers/*.json -o human.csv --study study.html --report collected.html
  lull train data.h5 --human human.csv -o model.h5

Exit codes: 0 success, 1 input or environment error, 2 usage error, 130 interrupted.)";

void AddStudyOptions(CLI::App& app, StudySettings* s) {
    AddOption(app, kOptions, "--repeats", &s->repeats, "Ask this fraction of the blocks twice", "X",
              Between(0.0, 1.0));
    AddOption(app, kOptions, "--catches", &s->catches,
              "Check observers in this fraction of the blocks", "X", Between(0.0, 0.5));
}

[[noreturn]] void Refuse(const std::string& message) {
    throw CLI::ValidationError("study", message);
}

void AddOptions(CLI::App& app, Options* s) {
    AddRenderSettings(app, &s->render);
    app.get_option("SCENE")->required(false);
    AddOption(app, kOptions, "--images", &s->images,
              "Read images of another renderer, with the spp in their file names", "DIR");
    AddOption(app, kOptions, "--collect", &s->collect, "Collect these files of answers",
              "ANSWERS.json ...");
    AddOption(app, kCommonOptions, "-o,--output", &s->output,
              "The page to make, or the thresholds to write", "STUDY.html|HUMAN.csv");
    app.add_option("--name", s->name, "Name the viewpoint, as in thresholds files [the scene's]")
        ->check(CheckViewpointName);
    app.add_option("--levels", s->levels,
                   "Set the number of sample counts per block [each 1.25 times the last]")
        ->check(Between(2, 200))
        ->type_name("N");
    AddOption(app, kOptions, "--record", &s->record,
              "Record the block histories of the render in this data set", "DATA.h5");
    AddCheckpointInterval(app, &s->render.checkpoint);
    AddStudyOptions(app, &s->study);
    AddOption(app, kOptions, "--study", &s->studyPage,
              "With --collect: take only answers to this study", "STUDY.html");
    AddOption(app, kCommonOptions, "--report", &s->report,
              "Write a page of the answers, with --collect", "PAGE.html");
    app.footer(kFooter);
}

void CheckOptions(const CLI::App& app, const Options& s) {
    if (s.output.empty()) throw CLI::ValidationError("--output", "is required");
    const bool hasScene = !s.render.scene.file.empty();
    if (int(hasScene) + int(!s.images.empty()) + int(!s.collect.empty()) != 1)
        Refuse("a SCENE is needed, or --images, or --collect; one of them");
    if (s.collect.empty() && !s.output.ends_with(".html"))
        Refuse("-o " + s.output + ": a study is a page, STUDY.html");
    if (!s.collect.empty() && !s.output.ends_with(".csv"))
        Refuse("-o " + s.output + ": collected thresholds are a table, HUMAN.csv");
    if (!s.record.empty() && !hasScene) Refuse("--record needs a SCENE, which is rendered");
    if (s.collect.empty() && !(s.report.empty() && s.studyPage.empty()))
        Refuse("--report and --study need --collect");
    if (!s.report.empty() && !s.report.ends_with(".html"))
        Refuse("--report " + s.report + ": the report is a page, PAGE.html");
    if (!s.images.empty()) AllowOnly(app, kOptionsOfPictures, "with --images");
    if (!s.collect.empty()) AllowOnly(app, kOptionsOfAnswers, "with --collect");
}

void WriteStudy(const Options& settings, const Study& study, ResultFiles* results) {
    RunWithThreads(settings.render.scene.compile.threads, [&] {
        results->WriteText(settings.output, MakeStudyPage(study, settings.study));
    });
    if (!settings.render.quiet)
        PrintToStderr("lull: {} blocks at {} levels: {} spp\n", study.blocks.size(),
                      study.levels.size(), fmt::join(study.levels, ", "));
}

ExitCode MakeStudyOfImages(const Options& settings) {
    std::vector<NamedFile> pictures;
    std::error_code error;
    for (const auto& entry : std::filesystem::directory_iterator(settings.images, error))
        pictures.push_back({"a picture", entry.path()});
    CheckOutputs(std::vector<NamedFile>{{"-o", settings.output}}, pictures);
    const std::optional<FileLock> lock = LockOutput(settings.output);
    const Study study =
        MakeStudy(FindPictures(settings.images, settings.name), settings.render.schedule.blockSize,
                  settings.levels, kLadderRatio);
    ResultFiles results;
    WriteStudy(settings, study, &results);
    results.PrintAndCheck();
    return kDone;
}

// Returns the levels of the ladder, which ends at the cap. Throws Error where they are too few, or
// too many for the memory.
std::vector<int> LevelsOf(const Options& options, const ScheduleOptions& schedule,
                          const PixelRect& region) {
    const std::vector<int> levels =
        options.levels > 0 ? LadderByCount(schedule.passLength, schedule.cap, options.levels)
                           : LadderByRatio(schedule.passLength, schedule.cap, kLadderRatio);
    if (levels.size() < 2)
        throw Error("--max-spp {}: a ladder needs more than one pass of {} spp", schedule.cap,
                    schedule.passLength);
    // As pixels, and as the text of the page, of which a part is there twice.
    CheckMemory(region.Area() * int64_t(levels.size()) * 12,
                fmt::format("a study of {}x{} pixels at {} levels", region.Width(), region.Height(),
                            levels.size()),
                "make it with fewer --levels, of a part with --crop, or smaller with --resolution");
    return levels;
}

ExitCode MakeStudyOfScene(Options options) {
    RenderSettings& settings = options.render;
    settings.schedule.cap = settings.cap.value_or(settings.schedule.cap);
    settings.checkpoint =
        ResumeIfThere(options.output + ".checkpoint", settings.checkpoint.interval);
    RenderJob render(settings, nullptr);
    const ScheduleOptions& schedule = render.settings.schedule;
    const PixelRect& region = render.region;
    const std::vector<Block> blocks = MakeBlocks(region, schedule);
    const std::vector<int> levels = LevelsOf(options, schedule, region);
    render.CheckFiles({{"-o", options.output}, {"--record", options.record}});
    render.LockResults(options.output);
    const bool isRecorded = !options.record.empty();
    if (isRecorded) CheckRecordable(blocks, schedule);
    std::vector<ViewpointRecording> dataset;
    if (isRecorded) dataset = ReadDatasetIfThere(options.record);

    render.Compile();
    render.provenance.criterion =
        fmt::format("judge:{}{}", fmt::join(levels, ","), isRecorded ? ":record" : "");
    SessionOptions how = render.MakeSessionOptions(false);
    how.identity = render.Identity();
    const std::string name = options.name.empty() ? SceneName(settings.scene.file) : options.name;
    ViewpointRecording viewpoint = MakeViewpoint(name, schedule, how.identity, blocks.size());
    if (isRecorded) AddToDataset(viewpoint, &dataset);  // says now whether it does not fit
    Study study = BeginStudy(name, region, levels, blocks, how.identity);
    Session session(*render.scene, region, how);
    const RenderResult result = render.Run(&session, [&](const auto&... how) {
        return RenderStudy(how..., &study, isRecorded ? &viewpoint : nullptr);
    });
    if (const auto code = render.End(result.cancelled)) return *code;

    ResultFiles results;
    WriteStudy(options, study, &results);
    if (isRecorded) WriteRecording(viewpoint, options.record, MessagesOf(settings), &results);
    results.PrintAndCheck();
    render.RemoveCheckpoint();
    return kDone;
}

void Tell(const Collected& collected) {
    for (const RefusedAnswers& refused : collected.refused)
        PrintToStderr("lull: {}: {}; left out\n", refused.file, refused.reason);
    for (const CheckedObserver& observer : collected.observers)
        if (!observer.leftOut.empty())
            PrintToStderr("lull: {}: {} {}; left out\n", observer.answers.file,
                          observer.answers.observer, observer.leftOut);
        else if (!observer.doubts.empty())
            PrintToStderr("lull: {}: {} counts, but {}\n", observer.answers.file,
                          observer.answers.observer, observer.doubts);
}

void SayCertainty(const CollectedViewpoint& viewpoint) {
    PrintToStderr("lull: {}: {} observer{}\n", viewpoint.name, viewpoint.observers,
                  viewpoint.observers == 1 ? "" : "s");
    if (const int fewest = FewestAnswers(viewpoint); fewest < kEnoughAnswers)
        PrintToStderr(
            "lull: {}: thresholds of blocks rest on as few as {} answer{}; they are rough with "
            "fewer than {}\n",
            viewpoint.name, fewest, fewest == 1 ? "" : "s", kEnoughAnswers);
}

// Returns the files of single answers with their contents; each of several viewpoints has its own.
std::map<std::string, std::string> SingleAnswers(const Collected& collected,
                                                 const std::string& base) {
    std::map<std::string, std::string> files;
    for (const CollectedViewpoint& viewpoint : collected.viewpoints) {
        const std::string name =
            collected.viewpoints.size() > 1 ? base + "." + viewpoint.name : base;
        const std::string text = SingleAnswersCsv(collected, viewpoint.name);
        if (!text.empty()) files.emplace(name + ".answers.csv", text);
    }
    return files;
}

std::string ThresholdsCsv(const Collected& collected) {
    std::ostringstream csv;
    WriteThresholds(csv, ThresholdsOf(collected));
    return csv.str();
}

void CollectAnswers(const Options& settings) {
    const std::string base = settings.output.substr(0, settings.output.rfind('.'));
    const std::string details = base + ".details.csv", observers = base + ".observers.csv";
    std::vector<NamedFile> inputs = {{"--study", settings.studyPage}};
    for (const std::string& file : settings.collect) inputs.push_back({"--collect", file});
    CheckOutputs(std::vector<NamedFile>{{"-o", settings.output},
                                        {"-o", details},
                                        {"-o", observers},
                                        {"--report", settings.report}},
                 inputs);

    CollectOptions options;
    Json study;
    if (!settings.studyPage.empty()) {
        study = ReadStudyPage(settings.studyPage);
        options.study = study.at("id").get<std::string>();
    }
    const Collected collected = CollectFiles(settings.collect, options);
    Tell(collected);
    if (collected.viewpoints.empty())
        throw Error("--collect: none of {} files has answers that count", settings.collect.size());

    // Written in this order, and printed.
    std::vector<std::pair<std::string, std::string>> files = {
        {settings.output, ThresholdsCsv(collected)},
        {details, DetailsCsv(collected)},
        {observers, ObserversCsv(collected)}};
    for (auto& [file, text] : SingleAnswers(collected, base)) {
        CheckOutputs(std::vector<NamedFile>{{"-o", file}}, inputs);
        files.emplace_back(file, text);
    }
    if (!settings.report.empty())
        files.emplace_back(settings.report, MakeCollectedPage(collected, study));
    for (const auto& [file, text] : files) WriteFileAtomically(file, text);
    if (!settings.render.quiet)
        for (const CollectedViewpoint& viewpoint : collected.viewpoints) SayCertainty(viewpoint);
    for (const auto& [file, text] : files) fmt::print("{}\n", file);
}

ExitCode Run(Options settings) {
    if (settings.collect.empty())
        return settings.images.empty() ? MakeStudyOfScene(settings) : MakeStudyOfImages(settings);
    CollectAnswers(settings);
    return kDone;
}

}  // namespace

void AddCommand(CLI::App& app, Command* command) {
    CLI::App* study = app.add_subcommand(
        "study", "Makes a page on which observers mark visible noise, and collects their answers.");
    auto settings = std::make_shared<Options>();
    // As lull record renders, so that answers are to what it records.
    settings->render.sampler = SamplerKind::Random;
    settings->render.estimator = Estimator::PbrtV3;
    AddOptions(*study, settings.get());
    study->callback([=] {
        CheckOptions(*study, *settings);
        *command = [=] { return Run(*settings); };
    });
}

}  // namespace lull::study
