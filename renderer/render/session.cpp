#include "renderer/render/session.h"

#include <fmt/format.h>
#include <tbb/info.h>

#include <filesystem>

#include "renderer/base/error.h"
#include "renderer/base/memory.h"
#include "renderer/denoise/denoiser.h"
#include "renderer/files/file_io.h"
#include "renderer/render/peers.h"
#include "renderer/render/time_limit.h"

namespace lull {

namespace {

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
    CheckGuide(options.guide, scene, options.estimator);
    if (options.guide.mode == GuideMode::Off || WhyNotGuided(scene, options.estimator)) return;
    learner.emplace(scene,
                    LearningOptions{.mode = options.guide.mode,
                                    .megabytes = options.guide.megabytes,
                                    .isShort = bool(options.clock)},
                    region.Area());
    options.render.learner = &*learner;
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
    std::vector<std::byte> guide;
    interrupted = ReadCheckpoint(checkpoint.file, options.identity, &film, options.render.layers,
                                 &guide, checkpoint.mayDiffer);
    if (learner) try {
            learner->Take(guide, film);
        } catch (const std::runtime_error& e) {
            throw Error(checkpoint.file + ": " + e.what());
        }
    Tell(options.onResume, "going on from {}{}", checkpoint.file,
         interrupted->criteria.empty() ? ", with another rule" : "");
}

GuideFigures Session::Guidance() const {
    if (learner) return learner->Figures();
    GuideFigures figures;
    figures.why = WhyNotGuided(scene, options.estimator).value_or("nobody asked for it");
    return figures;
}

void Session::Preview(double seconds, std::function<void(const RenderResult&)> show) {
    options.render.onPreview = std::move(show);
    options.render.previewInterval = seconds;
}

RenderResult Session::Run(const RenderFunction& render) {
    RenderOptions& o = options.render;
    SetSource();
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
    if (options.guide.mode != GuideMode::Off)
        Tell(options.onLearning, "{}", TextOf(Guidance(), options.guide.mode));
    if (o.display) o.display->Show(region, film);  // some may have been undone
    return result;
}

void Session::SetSource() {
    // A denoiser does best with what is seen in mirrors and through glass; layers, which are of the
    // same hits, come first.
    PathOptions paths = options.estimator;
    paths.throughSpecular = options.aovs.Any() ? options.aovs.throughSpecular : options.features;
    source = learner ? SamplesOf(scene, *learner, paths.throughSpecular) : SamplesOf(scene, paths);
}

// A checkpoint that cannot be written is a warning: the last good one stays, and so does the
// render.
void Session::KeepCheckpoints() {
    if (!HasCheckpoint()) return;
    options.render.checkpointInterval = options.checkpoint.interval;
    if (options.checkpoint.isKept) options.render.checkpointAtEnd = true;
    options.render.onCheckpoint = [this, said = std::string()](const RenderState& state) mutable {
        said = TryToWrite(state, said);
    };
}

// Warns of a checkpoint that could not be written, and returns of what; "" if it was. What `said`
// holds is not said again: a disk stays full for more than one attempt.
std::string Session::TryToWrite(const RenderState& state, const std::string& said) try {
    WriteCheckpoint(options.checkpoint.file, options.identity, state, film, options.render.layers,
                    learner ? learner->Save() : std::vector<std::byte>());
    return "";
} catch (const Error& e) {
    if (e.what() != said) Tell(options.onWarning, "no checkpoint: {}", e.what());
    return e.what();
}

}  // namespace lull
