// `lull judge`: people say where they still see noise.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <filesystem>

#include "renderer/base/memory.h"
#include "renderer/base/say.h"
#include "renderer/commands/command.h"
#include "renderer/commands/input_files.h"
#include "renderer/commands/interrupt.h"
#include "renderer/commands/session_options.h"
#include "renderer/files/file_io.h"
#include "renderer/input/scene_hash.h"
#include "renderer/lab/commands/judge_options.h"
#include "renderer/lab/viewpoints/study_render.h"
#include "stopping/base/parallel.h"

namespace lull {

namespace {

void WriteStudy(const JudgeSettings& settings, const Study& study) {
    WriteFileAtomically(settings.output, MakeStudyPage(study, settings.study));
    if (!settings.render.quiet)
        Say("lull: {} blocks at {} levels: {} spp\n", study.blocks.size(), study.levels.size(),
            fmt::join(study.levels, ", "));
    fmt::print("{}\n", settings.output);
}

// Names a viewpoint after the folder of its pictures.
std::string FolderName(std::string folder) {
    while (folder.size() > 1 && folder.ends_with('/')) folder.pop_back();
    return SceneName(folder);
}

ExitCode MakeStudyOfImages(const JudgeSettings& settings) {
    std::vector<NamedFile> pictures;
    std::error_code error;
    for (const auto& entry : std::filesystem::directory_iterator(settings.images, error))
        pictures.push_back({"a picture", entry.path()});
    CheckOutputs(std::vector<NamedFile>{{"-o", settings.output}}, pictures);
    const std::string name = settings.name.empty() ? FolderName(settings.images) : settings.name;
    const Study study = ReadStudy(settings.images, name, settings.render.schedule.blockSize,
                                  settings.levels, kLadderRatio);
    RunWithThreads(settings.render.scene.compile.threads, [&] { WriteStudy(settings, study); });
    return kDone;
}

ExitCode MakeStudyOfScene(const JudgeSettings& options) {
    RenderSettings settings = options.render;
    ScheduleOptions& schedule = settings.schedule;
    schedule.cap = settings.cap.value_or(schedule.cap);
    SceneInput input(settings.scene, {.grid = GridOf(schedule)});
    const std::vector<Block> blocks = MakeBlocks(input.region, schedule);
    const std::vector<int> levels =
        options.levels > 0 ? LadderByCount(schedule.passLength, schedule.cap, options.levels)
                           : LadderByRatio(schedule.passLength, schedule.cap, kLadderRatio);
    if (levels.size() < 2)
        throw Error(fmt::format("--cap {}: a ladder needs more than one pass of {} spp",
                                schedule.cap, schedule.passLength));
    // As pixels, and as the text of the page, of which a part is there twice.
    CheckMemory(input.region.Area() * int64_t(levels.size()) * 12,
                fmt::format("a study of {}x{} pixels at {} levels", input.region.Width(),
                            input.region.Height(), levels.size()),
                "make it with fewer --levels, of a part with --crop, or smaller with --resolution");
    const std::string name = options.name.empty() ? SceneName(settings.scene.file) : options.name;
    const bool records = !options.record.empty();
    const std::string file = options.output + ".checkpoint";
    CheckOutputs(
        std::vector<NamedFile>{
            {"-o", options.output}, {"--record", options.record}, {"the checkpoint", file}},
        InputsOf(settings.scene, input.description));
    std::vector<ViewpointRecording> dataset;
    if (records) {
        CheckRecordable(blocks, schedule);
        dataset = ReadDatasetIfThere(options.record);
    }

    const std::unique_ptr<const Scene> scene = CompileScene(settings, &input);
    Provenance provenance = MakeProvenance(settings, *scene, input.film);
    provenance.criterion =
        fmt::format("judge:{}{}", fmt::join(levels, ","), records ? ":record" : "");
    const RenderIdentity identity = IdentityOf(provenance, SceneHash(input.description));
    ViewpointRecording viewpoint = MakeViewpoint(name, schedule, identity, blocks.size());
    if (records) AddToDataset(viewpoint, &dataset);  // says now whether it does not fit

    Study study = BeginStudy(name, input.region, levels, blocks, identity);
    SessionOptions how = MakeSessionOptions(settings, provenance.sampler, false, nullptr);
    how.checkpoint = ResumeIfThere(file, settings.checkpoint.interval);
    how.identity = identity;
    Session session(*scene, input.region, how);
    session.Resume();
    CatchInterrupts();
    const RenderResult result = session.Run([&](auto&&... render) {
        return RenderStudy(render..., &study, records ? &viewpoint : nullptr);
    });
    if (result.cancelled) return SayInterrupted(settings, file);

    RunWithThreads(settings.scene.compile.threads, [&] { WriteStudy(options, study); });
    if (records) {
        AddToDataset(viewpoint, &dataset);
        WriteFileAtomically(options.record, EncodeDataset(dataset));
        fmt::print("{}\n", options.record);
    }
    std::filesystem::remove(file);
    return kDone;
}

ExitCode RunJudge(JudgeSettings settings) {
    if (!settings.textFile.empty()) settings.study.text = ReadStudyText(settings.textFile);
    if (settings.collect.empty())
        return settings.images.empty() ? MakeStudyOfScene(settings) : MakeStudyOfImages(settings);
    CollectAnswers(settings);
    return kDone;
}

}  // namespace

void AddJudgeCommand(CLI::App& app, Command* command) {
    CLI::App* judge = app.add_subcommand(
        "judge", "Lets people say where they see noise: makes a page for it, collects answers.");
    auto settings = std::make_shared<JudgeSettings>();
    AddJudgeOptions(*judge, settings.get());
    judge->callback([=] {
        CheckJudgeOptions(*settings);
        *command = [=] { return RunJudge(*settings); };
    });
}

}  // namespace lull
