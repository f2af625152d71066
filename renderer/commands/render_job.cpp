#include "renderer/commands/render_job.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <filesystem>

#include "renderer/commands/checkpoint_options.h"
#include "renderer/commands/render_files.h"
#include "renderer/input/description.h"
#include "renderer/mpi/job.h"
#include "stopping/rules/lnoise.h"

namespace lull {

namespace {

// Lets all ranks share a render, of which a warning says so if one does not answer.
void ShareAmongRanks(MpiJob* ranks, SessionOptions* options) {
    options->agree = [ranks](const std::string& what) { ranks->Begin(what); };
    options->render.peers = ranks->GetPeers();
    options->render.events.onSilence = [ranks](const std::vector<int>& silent) {
        ranks->Warn(
            fmt::format("rank {} does not respond; if it has died, --resume continues from the "
                        "last checkpoint, with any number of ranks",
                        fmt::join(silent, ", ")));
    };
    options->render.events.onGivenUp = [ranks](int rank, double seconds) {
        ranks->GiveUp(rank);
        ranks->Warn(
            fmt::format("rank {} has not responded for {}; continuing without it and taking its "
                        "samples again",
                        rank, FormatDuration(seconds)));
    };
}

}  // namespace

RenderJob::RenderJob(const RenderSettings& given, MpiJob* ranks, bool withHalf)
    : settings(given),
      ranks(ranks),
      input(settings.scene, {.grid = GridOf(settings.schedule), .withHalf = withHalf},
            MessagesOf(settings)) {
    if (input.film.isPair) settings.schedule.eyeWidth = input.film.Size().x();
}

bool RenderJob::Leads() const { return !ranks || ranks->Rank() == 0; }

void RenderJob::CheckFiles(std::vector<NamedFile> outputs, std::vector<NamedFile> inputs) {
    if (!Leads()) return;
    const CheckpointOptions& checkpoint = settings.checkpoint;
    outputs.push_back({checkpoint.isImplied ? "the checkpoint" : "--checkpoint", checkpoint.file});
    for (const NamedFile& file : InputsOf(settings.scene, input.description))
        inputs.push_back(file);
    CheckOutputs(outputs, inputs);
    LockCheckpoint();
    CheckCheckpoint(checkpoint);
}

void RenderJob::LockCheckpoint() {
    checkpointLock.reset();
    if (const std::string& file = settings.checkpoint.file; Leads() && !file.empty())
        checkpointLock.emplace(LockCheckpointFile(file));
}

void RenderJob::LockResults(const std::string& output) {
    resultLock.reset();
    if (!Leads()) return;
    if (std::optional<FileLock> lock = LockOutput(output)) resultLock.emplace(std::move(*lock));
}

void RenderJob::DenoiseBlocks() {
    denoiser = std::make_shared<BlockDenoiser>(MakeBlocks(input.region, settings.schedule));
}

void RenderJob::CheckSampler() const {
    if (!denoiser || settings.sampler != SamplerKind::Sobol || !Leads()) return;
    MessagesOf(settings).Warn(
        "the halves of one Sobol sequence complement each other, so that the error of the denoised "
        "image is underestimated; --sampler sobol-halves has a sequence for each half");
}

Rule RenderJob::ReadRule(const std::string& option, const std::string& rule) const {
    std::map<std::string, SignalMeasure> measures;
    if (denoiser) measures[kDenoisedRuleName] = MeasureOf(denoiser);
    return ReadRuleOption(option, rule, settings, input.region, std::move(measures));
}

void RenderJob::Compile() {
    scene = CompileScene(settings, &input);
    const bool isChosen = !settings.scene.integrator.empty();
    if (isChosen && TracesFromLights(scene->integrator) && settings.estimator == Estimator::PbrtV3)
        throw UsageError(
            "--integrator bdpt has no estimator of pbrt-v3's, by which lull record renders unless "
            "told otherwise; give --estimator combined, or leave --integrator bdpt out");
    if (!settings.sampler)
        settings.sampler = DefaultSampler(settings.purpose, settings.estimator, *scene);
    provenance = MakeProvenance(settings, *scene, input.film);
}

RenderIdentity RenderJob::Identity() const {
    return IdentityOf(provenance, SceneHash(input.description));
}

SessionOptions RenderJob::MakeSessionOptions(bool adaptive) const {
    SessionOptions options = lull::MakeSessionOptions(settings, adaptive, ranks);
    options.checkpoint = settings.checkpoint;
    return options;
}

RenderResult RenderJob::Run(Session* session, const RenderFunction& render) const {
    if (denoiser) denoiser->Show(&session->GetFilm());
    session->Resume();
    CatchInterrupts();
    return session->Run(render);
}

std::optional<ExitCode> RenderJob::End(bool isInterrupted) const {
    if (ranks) ranks->End();
    if (!Leads()) return kDone;
    if (!isInterrupted) return {};
    MessagesOf(settings).Note("interrupted; " + HowToGoOn(settings.checkpoint));
    return kInterrupted;
}

void RenderJob::RemoveCheckpoint() const {
    const CheckpointOptions& checkpoint = settings.checkpoint;
    if (!checkpoint.file.empty() && !checkpoint.isKept) std::filesystem::remove(checkpoint.file);
}

void SetWording(const RenderSettings& settings, MpiJob* ranks) {
    if (!settings.jsonProgress) return;
    ranks->SetWording([](const std::string& kind, const std::string& message) {
        return JsonEvent(kind, message);
    });
}

SessionOptions MakeSessionOptions(const RenderSettings& settings, bool adaptive, MpiJob* ranks) {
    SessionOptions options;
    RenderOptions& render = options.render;
    render.schedule = settings.schedule;
    render.sampler = Sampler(settings.sampler.value(), settings.seed);
    render.threads = settings.scene.compile.threads;
    render.isCancelled = Interrupted;
    RenderEvents& events = render.events;
    const auto printer = std::make_shared<ProgressPrinter>(MakePrinter(settings, adaptive));
    events.onProgress = [printer](const RenderProgress& p) { printer->Print(p); };
    events.onFinish = [printer](const RenderProgress& p) { printer->Finish(p); };
    const Messages messages = MessagesOf(settings);
    events.onResume = [messages](const std::string& message) { messages.Note(message); };
    events.onWarning = [messages](const std::string& message) { messages.Warn(message); };
    options.estimator = settings.estimator;
    options.film.grid = GridOf(settings.schedule);
    if (ranks) ShareAmongRanks(ranks, &options);
    return options;
}

}  // namespace lull
