#include "renderer/render/guide_learning.h"

#include <fmt/format.h>

#include <chrono>

#include "renderer/base/color.h"
#include "renderer/base/error.h"
#include "renderer/base/seconds_since.h"
#include "renderer/render/guide_trial.h"
#include "renderer/render/progress.h"

namespace lull {

namespace {

constexpr int kFirstRound = 4;  // samples per pixel; each round has twice the last one's
constexpr int64_t kPathsEnough = 16 << 20;  // after so many, more do not make a better guide

uint64_t SeedOf(uint64_t seed, int round) {
    uint64_t h = (seed + 1) * 0x9e3779b97f4a7c15ull + uint64_t(round + 2) * 0xbf58476d1ce4e5b9ull;
    h = (h ^ (h >> 31)) * 0x94d049bb133111ebull;
    return h ^ (h >> 29);
}

// Cells that the first round has to record in.
constexpr int kFirstDepth = 9, kFirstQuadDepth = 3;

// What a vertex costs with a guide over without (renderer/docs/guiding.md).
constexpr double kVertexCost = 1.45;

int RoundSamples(int round) { return kFirstRound << round; }
int SamplesUntil(int round) { return kFirstRound * ((1 << round) - 1); }

// Returns the samples per pixel that learning may take. What auto finds not to pay costs little.
int Budget(const LearningOptions& options) {
    return options.mode == GuideMode::Auto ? std::min(options.cap / 32, 64)
                                           : std::min(options.cap / 4, 512);
}

// Says whether there is to be another round after `round` of them.
bool GoesOn(const LearningOptions& options, const PixelRect& region, int round) {
    if (SamplesUntil(round) * region.Area() >= kPathsEnough) return false;
    return SamplesUntil(round + 1) <= Budget(options) && !(options.isEnough && options.isEnough());
}

RenderOptions MakeRenderOptions(const LearningOptions& options, int round, int spp) {
    RenderOptions render;
    render.schedule.cap = render.schedule.passLength = spp;
    render.sampler = options.sampler;
    render.seed = SeedOf(options.seed, round);
    render.threads = options.threads;
    render.isCancelled = options.isCancelled;
    return render;
}

// Returns the mean luminance of a sample; nothing where it was cancelled.
std::optional<double> MeanLuminance(const Scene& scene, const PixelRect& region,
                                    const LearningOptions& options) {
    const RenderOptions render = MakeRenderOptions(options, -1, 1);
    Film film(region, {.grid = GridOf(render.schedule)});
    if (Render(SamplesOf(scene, Estimator::Combined), render, &film).cancelled) return {};
    double sum = 0;
    const std::vector<float> means = film.MeanImage();
    for (size_t i = 0; i < means.size(); i += 3)
        sum += double(Luminance({means[i], means[i + 1], means[i + 2]}));
    return sum / double(std::max<int64_t>(1, region.Area()));
}

// Renders a round and records it. Returns false if it was cancelled.
bool RunRound(const Scene& scene, const PixelRect& region, const LearningOptions& options,
              Learning* learning) {
    GuideState& state = learning->state;
    PathOptions paths(state.guide);
    paths.record = &state.record;
    paths.usual = float(learning->usual);
    const RenderOptions render =
        MakeRenderOptions(options, learning->round, RoundSamples(learning->round));
    Film film(region, {.grid = GridOf(render.schedule)});
    return !Render(SamplesOf(scene, paths), render, &film).cancelled;
}

RefineOptions MakeRefineOptions(const LearningOptions& options, int round) {
    // The old state and the new are there at the same time.
    return {.maxBytes = (size_t(options.megabytes) << 20) / 2, .knowsFractions = round > 0};
}

// Adds what goes by until the end of its scope.
class Stopwatch {
  public:
    explicit Stopwatch(double* seconds) : seconds(seconds) {}
    ~Stopwatch() { *seconds += SecondsSince(start); }

  private:
    using Clock = std::chrono::steady_clock;
    double* seconds;
    const Clock::time_point start = Clock::now();
};

bool Finish(bool isUsed, const std::string& why, Learning* learning) {
    learning->figures.isUsed = isUsed;
    learning->figures.why = why;
    if (!isUsed) learning->guide = {};
    learning->state = {};
    learning->isDone = true;
    return true;
}

}  // namespace

std::string NameOf(GuideMode mode) {
    return mode == GuideMode::Off ? "off" : mode == GuideMode::Auto ? "auto" : "on";
}

std::optional<std::string> WhyNotGuided(const Scene& scene, Estimator estimator) {
    if (estimator != Estimator::Combined) return "the estimator is pbrt-v3's";
    if (scene.maxDepth < 2) return "paths have one bounce at most";
    if (scene.lights.Count() == 0) return "the scene has no light";
    return {};
}

void CheckGuide(const GuideOptions& options, const Scene& scene, Estimator estimator) {
    if (options.mode != GuideMode::On) return;
    if (const auto why = WhyNotGuided(scene, estimator))
        throw Error(fmt::format(
            "--guide on: {}, and paths are not guided there; give --guide auto or off", *why));
}

Learning NotGuided(const std::string& why) {
    Learning learning;
    learning.isDone = true;
    learning.figures.why = why;
    return learning;
}

std::string TextOf(const GuideFigures& f, GuideMode mode) {
    std::string text = fmt::format("guide: {}: {}", f.isUsed ? "used" : "not used", f.why);
    if (f.rounds == 0) return text;
    text += fmt::format("; learned from {} spp in {}, {:.1f} MB", f.samples,
                        FormatDuration(f.seconds), double(f.bytes) / (1 << 20));
    if (mode == GuideMode::Auto)
        text += fmt::format("; variance {:.2f} +- {:.2f}, vertices {:.2f} of those without",
                            f.variance, f.varianceError, f.vertices);
    return text;
}

// A round takes as long as all before it and a bit more. When half of the time is gone
// nevertheless, the render goes on without.
void HeedClock(const std::function<double()>& clock, LearningOptions* options) {
    constexpr double kStartsNoRound = 0.05, kGivesUp = 0.5;
    const double all = clock();
    options->isEnough = [=] { return all - clock() > kStartsNoRound * all; };
    options->isCancelled = [=, isCancelled = options->isCancelled] {
        return (isCancelled && isCancelled()) || all - clock() > kGivesUp * all;
    };
}

bool Learn(const Scene& scene, const PixelRect& region, const LearningOptions& options,
           Learning* learning, const std::function<void(const Learning&)>& onRound) {
    if (learning->isDone) return true;
    const bool isAuto = options.mode == GuideMode::Auto;
    const Stopwatch stopwatch(&learning->figures.seconds);
    if (isAuto && Budget(options) < 2 * kFirstRound)
        return Finish(false, "there are too few samples for learning to pay", learning);
    if (learning->round == 0) {
        const std::optional<double> usual = MeanLuminance(scene, region, options);
        if (!usual) return false;
        learning->figures.samples = 1;
        if (!(*usual > 0 && *usual < double(kInfinity)))
            return Finish(false, "the first samples found no light", learning);
        learning->usual = *usual;
        learning->state.guide = Guide(scene.shapes.bounds, kFirstDepth, kFirstQuadDepth);
        learning->state.record = GuideRecord(learning->state.guide);
    }
    for (bool goesOn = true; goesOn;) {
        if (!RunRound(scene, region, options, learning)) return false;
        const RefineOptions refine = MakeRefineOptions(options, learning->round);
        learning->figures.samples += RoundSamples(learning->round);
        learning->figures.rounds = ++learning->round;
        goesOn = GoesOn(options, region, learning->round);
        if (goesOn)
            learning->state = Refine(learning->state, refine);
        else
            learning->guide = FreezeGuide(learning->state, refine);
        if (goesOn && onRound) onRound(*learning);
    }
    learning->figures.bytes = int64_t(learning->guide.Bytes());
    learning->figures.leaves = int(learning->guide.leaves.size());
    if (!isAuto) return Finish(true, "as asked for", learning);

    const auto trial =
        TryGuide(scene, region, learning->guide, MakeRenderOptions(options, learning->round, 1));
    if (!trial) return false;
    learning->figures.samples += trial->samples;
    learning->figures.variance = trial->variance;
    learning->figures.varianceError = trial->error;
    learning->figures.vertices = trial->vertices;
    const double work = trial->vertices * kVertexCost;
    const bool pays = (trial->variance + 2 * trial->error) * work < 1;
    return Finish(pays,
                  fmt::format("variance times work is {} what it is without",
                              pays ? "below" : "not surely below"),
                  learning);
}

}  // namespace lull
