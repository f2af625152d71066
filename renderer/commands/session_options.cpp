#include "renderer/commands/session_options.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "renderer/base/say.h"
#include "renderer/commands/interrupt.h"
#include "renderer/commands/talk.h"
#include "renderer/mpi/job.h"

namespace lull {

namespace {

// Lets all ranks share a render, of which a warning says so if one does not answer.
void ShareAmongRanks(Job* job, SessionOptions* options) {
    options->agree = [job](const std::string& what) { job->Begin(what); };
    options->render.peers = job->ThePeers();
    options->render.events.onSilence = [job](const std::vector<int>& ranks) {
        job->Warn(
            fmt::format("rank {} does not answer; if it has died, --resume goes on from the "
                        "last checkpoint, with any number of ranks",
                        fmt::join(ranks, ", ")));
    };
    options->render.events.onGivenUp = [job](int rank, double seconds) {
        job->GiveUp(rank);
        job->Warn(
            fmt::format("rank {} has given no sign of life for {}: going on without it, and taking "
                        "its samples again",
                        rank, FormatDuration(seconds)));
    };
}

}  // namespace

SessionOptions MakeSessionOptions(const RenderSettings& settings, SamplerKind sampler,
                                  bool adaptive, Job* job) {
    SessionOptions options;
    RenderOptions& render = options.render;
    render.schedule = settings.schedule;
    render.sampler = sampler;
    render.seed = settings.seed;
    render.threads = settings.scene.compile.threads;
    render.isCancelled = Interrupted;
    RenderEvents& events = render.events;
    const auto printer = std::make_shared<ProgressPrinter>(MakePrinter(settings, adaptive));
    events.onProgress = [printer](const RenderProgress& p) { printer->Print(p); };
    events.onFinish = [printer](const RenderProgress& p) { printer->Finish(p); };
    options.estimator = settings.estimator;
    options.film.grid = GridOf(settings.schedule);
    const Talk talk = TalkOf(settings);
    events.onResume = [talk](const std::string& message) { talk.Note(message); };
    if (!settings.quiet) events.onLearning = events.onResume;
    events.onWarning = [talk](const std::string& message) { talk.Warn(message); };
    if (job) ShareAmongRanks(job, &options);
    return options;
}

void SetWording(const RenderSettings& settings, Job* job) {
    if (!settings.jsonProgress) return;
    job->SetWording([](const std::string& kind, const std::string& message) {
        return JsonEvent(kind, message);
    });
}

ExitCode SayInterrupted(const RenderSettings& settings, const std::string& checkpoint) {
    TalkOf(settings).Note("interrupted; the same command goes on from " + checkpoint);
    return kInterrupted;
}

}  // namespace lull
