#include "renderer/commands/render_job.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <signal.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cctype>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <utility>

#include "renderer/base/error.h"
#include "renderer/base/memory.h"
#include "renderer/files/file_io.h"
#include "renderer/input/description.h"
#include "renderer/mpi/job.h"
#include "stopping/base/input_file.h"
#include "stopping/rules/baselines.h"
#include "stopping/rules/rule_table.h"

namespace lull {

namespace {

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

std::string ForShell(const std::string& word) {
    const auto isPlain = [](char c) {
        return std::isalnum(static_cast<unsigned char>(c)) || std::strchr("_-+=./:,@%", c);
    };
    if (!word.empty() && std::ranges::all_of(word, isPlain)) return word;
    std::string quoted = "'";
    for (const char c : word) quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
    return quoted + "'";
}

// The one global variable: a signal handler can reach nothing else. Lock-free, hence safe in a
// handler, and visible to all threads, as a plain sig_atomic_t would not be.
std::atomic<bool> interrupted = false;
static_assert(std::atomic<bool>::is_always_lock_free);

extern "C" void OnSignal(int signal) {
    if (interrupted.exchange(true) && signal != SIGHUP) _exit(130);
}

}  // namespace

RenderJob::RenderJob(const RenderSettings& given, MpiJob* ranks, bool withHalf)
    : settings(given),
      ranks(ranks),
      warnings(MakePrintedWarnings(settings.scene, MessagesOf(settings))),
      description(LoadDescription(settings.scene, warnings)) {
    Warnings unheard;  // compiling the scene tells the film's
    filmSettings = MakeFilmSettings(description, settings.scene.compile.film, unheard);
    region = filmSettings.Region();
    CheckFilmFits(region, {.grid = GridOf(settings.schedule), .withHalf = withHalf});
    if (filmSettings.isPair) settings.schedule.eyeWidth = filmSettings.Size().x();
}

bool RenderJob::Leads() const { return !ranks || ranks->Rank() == 0; }

void RenderJob::CheckFiles(std::vector<NamedFile> outputs, std::vector<NamedFile> inputs) {
    if (!Leads()) return;
    const CheckpointOptions& checkpoint = settings.checkpoint;
    outputs.push_back({checkpoint.isImplied ? "the checkpoint" : "--checkpoint", checkpoint.file});
    inputs.push_back({"the scene", settings.scene.file});
    inputs.push_back({"--environment", settings.scene.environment});
    for (const std::string& file : FilesOf(description))
        inputs.push_back({"a file of the scene", file});
    CheckOutputs(outputs, inputs);
    if (checkpoint.file.empty()) return;
    checkpointLock.emplace(LockCheckpointFile(checkpoint.file));
    CheckWritable(checkpoint.file);
    // The render would replace it.
    if (!checkpoint.resume && IsThere(checkpoint.file))
        throw Error(checkpoint.file + ": already exists; give --resume to continue, or remove it");
}

void RenderJob::LockResults(const std::string& output) {
    if (!Leads()) return;
    if (std::optional<FileLock> lock = LockOutput(output)) resultLock.emplace(std::move(*lock));
}

void RenderJob::DenoiseBlocks() {
    denoiser = std::make_shared<BlockDenoiser>(MakeBlocks(region, settings.schedule));
}

void RenderJob::CheckSampler() const {
    if (!denoiser || settings.sampler != SamplerKind::Sobol || !Leads()) return;
    MessagesOf(settings).Warn(
        "the halves of one Sobol sequence complement each other, so that the error of the denoised "
        "image is underestimated; --sampler sobol-halves has a sequence for each half");
}

Rule RenderJob::ReadRule(const std::string& option, const std::string& rule,
                         std::optional<double> caution) const try {
    std::map<std::string, SignalMeasure> measures;
    if (denoiser) measures[kDenoisedRuleName] = MeasureOf(denoiser);
    if (IsRule(rule, kDenoisedRuleName) && !denoiser)
        throw UsageError(
            option + " " + rule +
            ": needs --denoise of lull render; lull compare --denoise adds a denoised image");
    const ScheduleOptions& schedule = settings.schedule;
    return ParseRule(rule, {.passSpp = schedule.passLength,
                            .blockCount = int(MakeBlocks(region, schedule).size()),
                            .cap = schedule.cap,
                            .sceneName = SceneName(settings.scene.file),
                            .models = ModelFolder(),
                            .caution = caution.value_or(settings.caution),
                            .measures = std::move(measures)});
} catch (const std::logic_error& e) {
    throw UsageError(option + ": " + e.what());
}

void RenderJob::Compile() {
    CompileOptions options = settings.scene.compile;
    // Lights are chosen by pbrt-v3's tables, however many there are.
    options.lightsAsPbrtV3 = settings.estimator == Estimator::PbrtV3;
    scene = lull::Compile(description, options, warnings);
    warnings.Summarize();
    MoveIntoLargePages();
    const bool isChosen = !settings.scene.integrator.empty();
    if (isChosen && TracesFromLights(scene->integrator) && settings.estimator == Estimator::PbrtV3)
        throw UsageError(
            "--integrator bdpt has no estimator of pbrt-v3's, by which lull record renders unless "
            "told otherwise; give --estimator combined, or leave --integrator bdpt out");
    if (!settings.sampler) settings.sampler = DefaultSampler(settings.estimator, *scene);
    provenance = {.version = LULL_VERSION,
                  .scene = settings.scene.file,
                  .seed = settings.seed,
                  .sampler = settings.sampler.value(),
                  .estimator = settings.estimator,
                  .criterion = "",
                  .checksum = "",
                  .schedule = settings.schedule,
                  .maxDepth = MaxDepth(scene->integrator),
                  .integrator = std::holds_alternative<PathIntegrator>(scene->integrator)
                                    ? ""
                                    : NameOf(scene->integrator, scene->isVolumetric),
                  .threads = settings.scene.compile.threads,
                  .substitute = settings.scene.substitute,
                  .resolution = filmSettings.resolution,
                  .crop = region};
}

RenderIdentity RenderJob::Identity() const {
    return IdentityOf(provenance, SceneHash(description));
}

SessionOptions RenderJob::MakeSessionOptions(bool adaptive, bool isShared) const {
    SessionOptions options;
    RenderOptions& render = options.render;
    render.schedule = settings.schedule;
    render.sampler = Sampler(settings.sampler.value(), settings.seed);
    render.threads = settings.scene.compile.threads;
    render.isCancelled = Interrupted;
    RenderEvents& events = render.events;
    const auto printer = std::make_shared<ProgressPrinter>(
        StyleOfReports(settings.jsonProgress, settings.quiet), adaptive, stderr);
    events.onProgress = [printer](const RenderProgress& p) { printer->Print(p); };
    events.onFinish = [printer](const RenderProgress& p) { printer->Finish(p); };
    const Messages messages = MessagesOf(settings);
    events.onResume = [messages](const std::string& message) { messages.Note(message); };
    events.onWarning = [messages](const std::string& message) { messages.Warn(message); };
    options.estimator = settings.estimator;
    options.film.grid = GridOf(settings.schedule);
    if (!isShared) return options;
    options.checkpoint = settings.checkpoint;
    if (ranks) ShareAmongRanks(ranks, &options);
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

CheckpointOptions ResumeIfThere(const std::string& file, double interval) {
    return {.file = file, .interval = interval, .resume = IsThere(file), .isImplied = true};
}

FileLock LockCheckpointFile(const std::string& file) {
    std::optional<FileLock> lock = FileLock::Try(file);
    if (!lock)
        throw Error(
            file +
            ": another process is writing this checkpoint; wait for its end, or name another "
            "file");
    return std::move(*lock);
}

std::string HowToGoOn(const CheckpointOptions& checkpoint) {
    if (checkpoint.file.empty()) return "with --checkpoint F.h5, it could be resumed";
    std::ifstream file("/proc/self/cmdline");
    std::string command;
    bool resumes = checkpoint.isImplied;
    for (std::string word; std::getline(file, word, '\0');) {
        command += (command.empty() ? "" : " ") + ForShell(word);
        resumes |= word == "--resume";
    }
    return "to resume: " + command + (resumes ? "" : " --resume");
}

void CatchInterrupts() {
    struct sigaction action = {};
    action.sa_handler = OnSignal;
    action.sa_flags = SA_RESTART;
    sigemptyset(&action.sa_mask);
    sigaction(SIGINT, &action, nullptr);
    sigaction(SIGTERM, &action, nullptr);
    struct sigaction before = {};
    sigaction(SIGHUP, nullptr, &before);
    if (before.sa_handler != SIG_IGN) sigaction(SIGHUP, &action, nullptr);
}

bool Interrupted() { return interrupted.load(std::memory_order_relaxed); }

void SetWording(const RenderSettings& settings, MpiJob* ranks) {
    if (!settings.jsonProgress) return;
    ranks->SetWording([](const std::string& kind, const std::string& message) {
        return JsonEvent(kind, message);
    });
}

}  // namespace lull
