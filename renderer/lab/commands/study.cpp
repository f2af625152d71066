// `lull study`: people say where they still see noise.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <filesystem>

#include "renderer/base/error.h"
#include "renderer/base/memory.h"
#include "renderer/commands/command.h"
#include "renderer/commands/render_job.h"
#include "renderer/files/outputs.h"
#include "renderer/lab/commands/study_options.h"
#include "renderer/lab/viewpoints/study.h"
#include "stopping/base/parallel.h"

namespace lull::study {

namespace {

void WriteStudy(const Options& settings, const Study& study, ResultFiles* results) {
    RunWithThreads(settings.render.scene.compile.threads, [&] {
        results->WriteText(settings.output, MakeStudyPage(study, settings.study));
    });
    if (!settings.render.quiet)
        PrintToStderr("lull: {} blocks at {} levels: {} spp\n", study.blocks.size(),
                      study.levels.size(), fmt::join(study.levels, ", "));
}

// Prints the names of the files. Throws Error where one is not where it should be.
void PrintFiles(const ResultFiles& results) {
    for (const std::string& name : results.Names()) fmt::print("{}\n", name);
    results.Check();
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
    PrintFiles(results);
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
        throw Error(fmt::format("--cap {}: a ladder needs more than one pass of {} spp",
                                schedule.cap, schedule.passLength));
    // As pixels, and as the text of the page, of which a part is there twice.
    CheckMemory(region.Area() * int64_t(levels.size()) * 12,
                fmt::format("a study of {}x{} pixels at {} levels", region.Width(), region.Height(),
                            levels.size()),
                "make it with fewer --levels, of a part with --crop, or smaller with --resolution");
    return levels;
}

// Recording of the study's render, on request.
struct Recording {
    std::string file;  // empty: nothing
    std::vector<ViewpointRecording> dataset;
    ViewpointRecording viewpoint;

    // Throws Error where the data set cannot take such a viewpoint.
    Recording(std::string output, const std::vector<Block>& blocks, const ScheduleOptions& schedule)
        : file(std::move(output)) {
        if (file.empty()) return;
        CheckRecordable(blocks, schedule);
        dataset = ReadDatasetIfThere(file);
    }
    void Begin(ViewpointRecording begun) {
        viewpoint = std::move(begun);
        if (!file.empty()) AddToDataset(viewpoint, &dataset);  // says now whether it does not fit
    }
    void Write(const Messages& messages, ResultFiles* results) const {
        if (file.empty()) return;
        results->Write(file, [&](const std::string& to) {
            AddToDatasetFile(viewpoint, to,
                             [&] { messages.Note("waiting for another process to write " + to); });
        });
    }
};

ExitCode MakeStudyOfScene(Options options) {
    RenderSettings& settings = options.render;
    settings.schedule.cap = settings.cap.value_or(settings.schedule.cap);
    settings.checkpoint =
        ResumeIfThere(options.output + ".checkpoint", settings.checkpoint.interval);
    RenderJob render(settings, nullptr);
    const ScheduleOptions& schedule = settings.schedule;
    const PixelRect& region = render.input.region;
    const std::vector<Block> blocks = MakeBlocks(region, schedule);
    const std::vector<int> levels = LevelsOf(options, schedule, region);
    render.CheckFiles({{"-o", options.output}, {"--record", options.record}});
    render.LockResults(options.output);
    Recording recording(options.record, blocks, schedule);

    render.Compile();
    render.provenance.criterion =
        fmt::format("judge:{}{}", fmt::join(levels, ","), options.record.empty() ? "" : ":record");
    SessionOptions how = render.MakeSessionOptions(false);
    how.identity = render.Identity();
    const std::string name = options.name.empty() ? SceneName(settings.scene.file) : options.name;
    recording.Begin(MakeViewpoint(name, schedule, how.identity, blocks.size()));
    Study study = BeginStudy(name, region, levels, blocks, how.identity);
    Session session(*render.scene, region, how);
    const RenderResult result = render.Run(&session, [&](const auto&... how) {
        return RenderStudy(how..., &study, recording.file.empty() ? nullptr : &recording.viewpoint);
    });
    if (const auto code = render.End(result.cancelled)) return *code;

    ResultFiles results;
    WriteStudy(options, study, &results);
    recording.Write(MessagesOf(settings), &results);
    PrintFiles(results);
    render.RemoveCheckpoint();
    return kDone;
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
