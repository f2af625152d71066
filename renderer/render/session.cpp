#include "renderer/render/session.h"

#include <fmt/format.h>
#include <tbb/global_control.h>
#include <tbb/info.h>
#include <tbb/task_arena.h>

#include <stdexcept>

#include "renderer/base/error.h"
#include "renderer/base/memory.h"
#include "renderer/denoise/denoiser.h"
#include "renderer/film/layer.h"
#include "renderer/progress/forecast.h"
#include "renderer/render/executor_internal.h"
#include "renderer/render/film_picture.h"
#include "renderer/render/light_rounds.h"
#include "renderer/render/peers.h"
#include "renderer/render/ranks/rank.h"
#include "renderer/render/render.h"
#include "stopping/base/input_file.h"
#include "stopping/base/parallel.h"

namespace lull {

namespace {

// Bytes a pixel of the rows that the denoiser has at hand, and of lists of what it finds.
constexpr int64_t kDenoiserRows = 16;

template <typename... Arguments>
void Tell(const std::function<void(const std::string&)>& listener,
          fmt::format_string<Arguments...> format, Arguments&&... arguments) {
    if (listener) listener(fmt::format(format, std::forward<Arguments>(arguments)...));
}

// Returns what the denoiser takes in addition to the sums: its inputs take the place of the half
// and of what it alone reads, which is freed row by row.
int64_t BytesOfDenoising(const LayerOptions& layers) {
    LayerOptions kept = layers;
    kept.features = false;
    const int64_t half = sizeof(std::array<double, 3>);
    const int64_t freed = Layers::Bytes(layers) - Layers::Bytes(kept) + half;
    const int64_t taken = kDenoiserBytes + (layers.groups.Count() > 0 ? kGroupsBytes : 0);
    return kDenoiserRows + std::max<int64_t>(0, taken - freed);
}

}  // namespace

FilmOptions FilmFor(const Scene& scene, FilmOptions options) {
    options.withSpreads = TracesFromLights(scene.integrator);
    return options;
}

int64_t BytesOfLayers(const LayerOptions& layers) {
    return Layers::Bytes(layers) + Layers::ChannelBytes(layers) +
           (layers.features ? BytesOfDenoising(layers) : 0);
}

void CheckFilmFits(const PixelRect& region, const FilmOptions& film, int64_t more) {
    FilmOptions sums = film;
    sums.layers = {};
    const int groups = film.layers.groups.Count();
    const int64_t splats = film.withSpreads ? (1 + groups) * int64_t(sizeof(SplatPixel)) : 0;
    const bool hasLayers = Layers::Bytes(film.layers) > 0;
    CheckMemory(
        Film::Bytes(region, sums) + region.Area() * (BytesOfLayers(film.layers) + splats + more),
        fmt::format("an image of {}x{} pixels{}", region.Width(), region.Height(),
                    hasLayers ? " with its layers" : ""),
        fmt::format("render it in parts with --crop, {}or smaller with --resolution",
                    groups > 0 ? "with fewer light groups, " : ""));
}

Session::Session(const Scene& scene, const PixelRect& region, SessionOptions given)
    : scene(scene),
      region(region),
      options(std::move(given)),
      film(region, FilmFor(scene, options.film)) {
    options.render.film = &film;
    if (TracesFromLights(scene.integrator)) {
        lightRounds = std::make_unique<LightRounds>(scene, film, options.render.sampler);
        options.render.lightRounds = lightRounds.get();
    }
}

Session::~Session() = default;

bool Session::Leads() const { return !options.render.peers || options.render.peers->Rank() == 0; }

void Session::Resume() {
    const CheckpointOptions& checkpoint = options.checkpoint;
    const auto& onResume = options.render.events.onResume;
    if (!Leads() || !checkpoint.resume) return;
    if (!IsThere(checkpoint.file)) {
        Tell(onResume, "there is no {} yet: from the start", checkpoint.file);
        return;
    }
    interrupted = ReadCheckpoint(checkpoint.file, options.identity, &film, checkpoint.mayDiffer);
    options.render.interrupted = &*interrupted;
    Tell(onResume, "going on from {}{}", checkpoint.file,
         interrupted->criteria.empty() ? ", with another rule" : "");
}

void Session::Preview(double seconds, std::function<void(const RenderResult&)> show) {
    options.render.events.onPreview = std::move(show);
    options.render.events.previewInterval = seconds;
}

RenderResult Session::Run(const RenderFunction& render) {
    const RenderEvents& events = options.render.events;
    Display* display = options.render.display;
    PathOptions paths = options.estimator;
    paths.throughSpecular = options.film.layers.aovs.throughSpecular;
    options.render.source = SamplesOf(scene, paths, lightRounds.get());
    SetClock();
    KeepCheckpoints();
    const Peers* peers = options.render.peers;
    const bool looks = options.firstLook && (!peers || peers->Count() == 1);
    if (looks) TakeFirstLook(SamplesOf(scene, options.estimator), options.render, &film);
    if (display && (interrupted || looks)) display->Show(region, film);
    if (options.agree) options.agree(TextOf(options.identity) + TextOf(PlanesOf(film)));
    RenderResult result = render(options.render);
    if (display) display->Show(region, film);  // some may have been undone
    if (Leads() && events.onFinish) events.onFinish(result.progress);
    return result;
}

void Session::SetClock() {
    if (!options.clock) return;
    double reserve = SecondsToWrite(region.Area());
    const int threads = ThreadCount(options.render.threads);
    const int pictures = std::max(1, options.film.layers.groups.Count());
    if (options.film.layers.features)
        reserve += pictures * SecondsToDenoise(region.Area(), threads);
    options.render.secondsLeft = [clock = options.clock, reserve] { return clock() - reserve; };
}

// A checkpoint that cannot be written is a warning: the last good one stays, and so does the
// render. The same warning is not repeated: a disk stays full for more than one attempt.
void Session::KeepCheckpoints() {
    if (options.checkpoint.file.empty()) return;
    const auto write = [this, said = std::string()](const RenderState& state) mutable {
        std::string problem;
        try {
            WriteCheckpoint(options.checkpoint.file, options.identity, state, film);
        } catch (const Error& e) {
            problem = e.what();
            if (problem != said)
                Tell(options.render.events.onWarning, "no checkpoint: {}", problem);
        }
        said = problem;
    };
    options.render.checkpoints = {write, options.checkpoint.interval, options.checkpoint.isKept};
}

namespace {

// This thread speaks with the other ranks, so the arena has none of its places for it.
RenderResult RenderWithPeers(const RenderOptions& options, int threads) {
    tbb::global_control limit(tbb::global_control::max_allowed_parallelism, size_t(threads) + 1);
    tbb::task_arena arena(threads, 0);
    RenderResult result =
        options.peers->Rank() == 0 ? LeadRanks(options, &arena) : FollowRanks(options, &arena);
    result.threads = threads * options.peers->Count();
    return result;
}

}  // namespace

RenderResult Render(const RenderOptions& options) {
    const PixelRect& region = options.film->Region();
    if (options.interrupted && !HasBlocksOf(*options.interrupted, region, options.schedule))
        throw std::invalid_argument("the interrupted render has other blocks");
    const int threads = ThreadCount(options.threads);
    const bool alone = !options.peers || options.peers->Count() == 1;
    if (!alone && options.display) throw std::invalid_argument("several ranks have no viewer");
    if (!alone) return RenderWithPeers(options, threads);
    tbb::global_control limit(tbb::global_control::max_allowed_parallelism, size_t(threads));
    tbb::task_arena arena(threads);
    RenderResult result = arena.execute([&] { return Executor(options, StartsOf(options)).Run(); });
    result.threads = threads;
    return result;
}

SampleSource SamplesOf(const Scene& scene, const PathOptions& options, const LightRounds* rounds) {
    return [&scene, options, rounds](Sampler& sampler, const Vec2i& pixel, uint32_t index,
                                     PathSample* sample) {
        PathOptions paths = options;
        if (rounds) paths.shares = rounds->Round().shares;
        RenderSample(scene, paths, sampler, pixel, index, sample);
    };
}

}  // namespace lull
