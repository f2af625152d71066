#include "renderer/render/session.h"

#include <fmt/format.h>
#include <tbb/info.h>

#include <filesystem>

#include "renderer/base/error.h"
#include "renderer/base/memory.h"
#include "renderer/files/file_io.h"
#include "renderer/render/guide_learning_state.h"
#include "renderer/render/peers.h"
#include "renderer/render/time_limit.h"

namespace lull {

namespace {

constexpr int64_t kDenoiserBytes = 230;  // a pixel, while it works

template <typename... Arguments>
void Tell(const std::function<void(const std::string&)>& listener,
          fmt::format_string<Arguments...> format, Arguments&&... arguments) {
    if (listener) listener(fmt::format(format, std::forward<Arguments>(arguments)...));
}

}  // namespace

void CheckCheckpoint(const CheckpointOptions& options) {
    if (options.file.empty()) return;
    CheckWritable(options.file);
    if (!options.resume && std::filesystem::exists(options.file))
        throw Error(options.file +
                    ": is there already; give --resume to go on from it, or remove it");
}

CheckpointOptions ResumeIfThere(const std::string& file, double interval) {
    return {.file = file, .interval = interval, .resume = std::filesystem::exists(file)};
}

void CheckLayersFit(const AovSet& wanted, bool features, const PixelRect& region) {
    // With what is made of them in the end.
    const size_t mattes =
        wanted.Mattes() ? MatteFilm::BytesOfPixel(wanted.cryptomatte) + 25 * sizeof(float) : 0;
    const int64_t bytes = (wanted.Sums() ? sizeof(AovPixel) + 2 * 13 * sizeof(float) : 0) + mattes +
                          (features ? sizeof(FeaturePixel) + kDenoiserBytes : 0);
    CheckMemory(region.Area() * bytes,
                fmt::format("layers of {}x{} pixels", region.Width(), region.Height()),
                "render it in parts with --crop, or smaller with --resolution");
}

Session::Session(const Scene& scene, const PixelRect& region, SessionOptions given)
    : scene(scene), region(region), options(std::move(given)), film(region, options.film) {
    if (options.aovs.Any()) options.identity["aov"] = TextOf(options.aovs);
    if (options.aovs.Sums()) {
        aovs.emplace(region, options.aovs);
        options.render.layers.aovs = &*aovs;
    }
    if (options.aovs.Mattes()) {
        mattes.emplace(region, options.aovs.cryptomatte);
        options.render.layers.mattes = &*mattes;
    }
    if (options.features) {
        features.emplace(region);
        options.render.layers.features = &*features;
        options.identity["features"] = "yes";
    }
}

void Session::DropFeatures() {
    features.reset();
    options.render.layers.features = nullptr;
}

bool Session::Leads() const { return !options.render.peers || options.render.peers->Rank() == 0; }

void Session::Resume() {
    const CheckpointOptions& checkpoint = options.checkpoint;
    if (!Leads() || !checkpoint.resume) return;
    if (!std::filesystem::exists(checkpoint.file)) {
        Tell(options.onResume, "there is no {} yet: from the start", checkpoint.file);
        return;
    }
    RenderState state = ReadCheckpoint(checkpoint.file, options.identity, &film,
                                       options.render.layers, &guide, checkpoint.mayDiffer);
    Tell(options.onResume, "going on from {}{}", checkpoint.file,
         state.criteria.empty() && !state.blocks.empty() ? ", with another rule" : "");
    if (!state.blocks.empty()) interrupted = std::move(state);  // else it was learning
}

LearningOptions Session::MakeLearningOptions() const {
    const RenderOptions& render = options.render;
    LearningOptions learn{.mode = options.guide.mode,
                          .megabytes = options.guide.megabytes,
                          .sampler = render.sampler,
                          .seed = render.seed,
                          .threads = render.threads,
                          .cap = render.schedule.cap,
                          .isCancelled = render.isCancelled,
                          .isEnough = {}};
    // Several ranks have to come to the same.
    if (render.peers && render.peers->Count() > 1)
        learn.isCancelled = {};
    else if (options.clock)
        HeedClock(options.clock, &learn);
    return learn;
}

bool Session::Learn() {
    if (options.guide.mode == GuideMode::Off) return true;
    CheckGuide(options.guide, scene, options.estimator);
    if (const auto why = WhyNotGuided(scene, options.estimator)) {
        learning = NotGuided(*why);
    } else {
        const LearningOptions learn = MakeLearningOptions();
        if (KeepsGuide() && !guide.empty()) try {
                learning = RestoreLearning(guide);
            } catch (const std::runtime_error& e) {
                throw Error(options.checkpoint.file + ": " + e.what());
            }
        const bool isNew = !learning.isDone;
        if (isNew) Tell(options.onLearning, "learning where light comes from");
        const auto onRound = [&](const Learning& l) {
            if (!KeepsGuide() || !Leads()) return;
            guide = SaveLearning(l);
            TryToWrite({}, Film(PixelRect()), {}, "");
        };
        if (!lull::Learn(scene, region, learn, &learning, onRound)) {
            if (options.render.isCancelled && options.render.isCancelled()) return false;
            learning = NotGuided("the time did not suffice for learning");
        }
        if (isNew) Tell(options.onLearning, "{}", TextOf(learning.figures, options.guide.mode));
    }
    if (KeepsGuide()) guide = SaveLearning(learning);
    return true;
}

RenderResult Session::Run(const RenderFunction& render) {
    RenderOptions& o = options.render;
    SetSources();
    KeepCheckpoints();
    if (options.clock) {
        double reserve = SecondsToWrite(region.Area());
        const int threads = o.threads > 0 ? o.threads : tbb::info::default_concurrency();
        if (options.features) reserve += SecondsToDenoise(region.Area(), threads);
        o.secondsLeft = [clock = options.clock, reserve] { return clock() - reserve; };
    }
    if (o.display && interrupted) o.display->Show(region, film);
    if (options.agree) options.agree(TextOf(options.identity) + (film.HasHalf() ? "half" : ""));
    RenderResult result = render(source, o, &film, interrupted ? &*interrupted : nullptr);
    if (o.display) o.display->Show(region, film);  // some may have been undone
    return result;
}

void Session::SetSources() {
    Layers& layers = options.render.layers;
    AovSet wanted = options.aovs;
    if (options.features) {
        // A denoiser does best with what is seen in mirrors and through glass; layers, which are of
        // the same hits, come first.
        if (!options.aovs.Any()) wanted.throughSpecular = true;
        wanted.albedo = wanted.normal = wanted.depth = true;
    }
    if (learning.figures.isUsed) {
        source = SamplesOf(scene, learning.guide);
        if (layers) layers.source = AovSamplesOf(scene, learning.guide, wanted);
    } else {
        source = SamplesOf(scene, options.estimator);
        if (layers) layers.source = AovSamplesOf(scene, options.estimator, wanted);
    }
}

// A checkpoint that cannot be written is a warning: the last good one stays, and so does the
// render.
void Session::KeepCheckpoints() {
    if (!HasCheckpoint()) return;
    options.render.checkpointInterval = options.checkpoint.interval;
    if (options.checkpoint.isKept) options.render.checkpointAtEnd = true;
    options.render.onCheckpoint = [this, said = std::string()](const RenderState& state) mutable {
        said = TryToWrite(state, film, options.render.layers, said);
    };
}

// Warns of a checkpoint that could not be written, and returns of what; "" if it was. What `said`
// holds is not said again: a disk stays full for more than one attempt.
std::string Session::TryToWrite(const RenderState& state, const Film& pixels, const Layers& layers,
                                const std::string& said) try {
    WriteCheckpoint(options.checkpoint.file, options.identity, state, pixels, layers, guide);
    return "";
} catch (const Error& e) {
    if (e.what() != said) Tell(options.onWarning, "no checkpoint: {}", e.what());
    return e.what();
}

}  // namespace lull
