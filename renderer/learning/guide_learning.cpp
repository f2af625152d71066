#include "renderer/learning/guide_learning.h"

#include <fmt/format.h>

#include <chrono>
#include <utility>

#include "renderer/base/error.h"
#include "renderer/base/seconds_since.h"
#include "renderer/learning/guide_learning_state.h"

namespace lull {

namespace {

// Samples per pixel of the first two rounds of `on`; each of the others has twice the last one's.
constexpr int kFirstRound = 4;
// Learning ends when so many paths, or samples per pixel, were recorded: more do not make a better
// guide. With a clock it ends earlier.
constexpr int64_t kPathsEnough = 16 << 20;
constexpr int kMost = 500, kMostWithClock = 60;

// A leaf is cut when it has seen more vertices, times the square root of the millions of paths that
// were recorded: so a guide gets finer in place and surer in direction alike (Müller 2017, section
// 5.3).
constexpr double kLeafVertices = 4000;

// Of auto: how many paths a round has, in samples per pixel at least and at most; the rounds that
// can go by before it begins; and those after which it can decide: the first, and the last.
constexpr int64_t kPathsOfRound = 1 << 20;
constexpr int kShortest = 4, kLongest = 16, kLeadOfAuto = 16, kFirstDecision = 3, kLastDecision = 7;

// Cost of a vertex, guided / unguided: 1.05 to 1.45 in 16 scenes at 128x128 pixels.
constexpr double kVertexCost = 1.2;

// Cells that the first round has to record in.
constexpr int kFirstDepth = 9, kFirstQuadDepth = 3;

// Adds the time until the end of its scope.
class Stopwatch {
  public:
    explicit Stopwatch(double* seconds) : seconds(seconds) {}
    ~Stopwatch() { *seconds += SecondsSince(start); }

  private:
    using Clock = std::chrono::steady_clock;
    double* seconds;
    const Clock::time_point start = Clock::now();
};

}  // namespace

std::optional<std::string> WhyNotGuided(const Scene& scene, Estimator estimator) {
    if (estimator != Estimator::Combined) return "the estimator is pbrt-v3's";
    if (!CanBeGuided(scene.integrator)) return "the integrator takes no guide";
    if (MaxDepth(scene.integrator) < 2) return "paths have one bounce at most";
    if (scene.lights.Count() == 0) return "the scene has no light";
    return {};
}

std::string TextOf(const GuideFigures& f, GuideMode mode) {
    std::string text = fmt::format("guide: {}: {}", f.isUsed ? "used" : "not used", f.why);
    if (f.directLight)
        text += fmt::format("; learned direct light: {}, variance {:.2f} +- {:.2f} of that without",
                            f.usesDirectLight ? "used" : "not used", f.directLight->variance,
                            f.directLight->error);
    if (f.rounds == 0) return text;
    text += fmt::format("; learned from {} spp, from {} spp on, {:.1f} MB", f.samples, f.from,
                        double(f.bytes) / (1 << 20));
    if (mode == GuideMode::Auto && f.rounds >= kFirstDecision)
        text += fmt::format("; variance {:.2f} +- {:.2f}, vertices {:.2f} of those without",
                            f.comparison.variance, f.comparison.error, f.comparison.vertices);
    return text;
}

GuideLearner::GuideLearner(const Scene& scene, const LearningOptions& options, int64_t pixels)
    : scene(scene),
      options(options),
      pace(int(
          std::clamp<int64_t>(kPathsOfRound / std::max<int64_t>(1, pixels), kShortest, kLongest))) {
    learning.figures.why = "no block took enough samples";
    learning.end = options.mode == GuideMode::Off ? kNoRoundEnd : RoundLength(0);
    if (options.directLight) learning.directLight = BeginDirectLight();
}

int GuideLearner::RoundLength(int round) const {
    if (options.mode == GuideMode::On) return kFirstRound << std::max(0, round - 1);
    if (round == 0) return options.isShort ? kFirstRound : kLeadOfAuto * pace;
    return learning.decided > 0 ? pace << (round - learning.decided) : pace;
}

bool GuideLearner::IsTrial() const {
    return options.mode == GuideMode::Auto && learning.round > 0 && learning.decided == 0 &&
           !learning.IsDone();
}

double GuideLearner::Variance(const Film& film, const PixelRect& part) const {
    double variance = 1;
    for (const auto* noise : {&learning.noise, &learning.directLight.noise})
        if (!noise->empty()) variance *= VarianceOf(*noise, film, part);
    return variance;
}

SampleSpread* GuideLearner::SpreadOf(const Film& film, const PixelRect& tile) {
    if (auto* spreads = SpreadsOf(&learning.directLight)) return &(*spreads)[film.TileAt(tile.min)];
    if (!IsTrial()) return nullptr;
    const int round = learning.round;
    if (round == 1) return &learning.tally.unguided[film.TileAt(tile.min)];
    if (round >= kFirstDecision) return &learning.tally.guided[film.TileAt(tile.min)];
    return nullptr;
}

void GuideLearner::EndRound(const Film& film) {
    const Stopwatch stopwatch(&learning.figures.seconds);
    const int end = RoundEnd();
    if (end == learning.directLight.end) EndDirectLightRound(scene, film, &learning.directLight);
    if (end == learning.end) EndGuideRound(film);
    if (options.directLight && learning.directLight.IsDone()) {
        learning.figures.usesDirectLight = learning.directLight.isUsed;
        learning.figures.directLight = learning.directLight.comparison;
    }
    SetPaths();
}

void GuideLearner::EndGuideRound(const Film& film) {
    const int64_t samples = film.SampleCount();
    const int length = RoundLength(learning.round);
    if (learning.round > 0) {
        learning.paths += samples - learning.samples;
        learning.figures.samples += length;
        learning.figures.rounds = learning.round;
    }
    const bool goesOn = learning.round == 0 ? Begin(film) : Learn(film);
    ++learning.round;
    learning.samples = samples;
    if (goesOn) learning.end += RoundLength(learning.round);
}

// Returns false if learning is done; so does Learn().
bool GuideLearner::Begin(const Film& film) {
    learning.usual = MeanLuminance(film);
    if (!(learning.usual > 0 && learning.usual < double(kInfinity)))
        return Finish(false, "the first samples found no light");
    learning.state.guide = Guide(scene.shapes.bounds, kFirstDepth, kFirstQuadDepth);
    learning.state.record = GuideRecord(learning.state.guide);
    learning.figures.from = learning.end;
    if (options.mode == GuideMode::Auto)
        learning.tally.unguided = learning.tally.guided =
            std::vector<SampleSpread>(film.TileCount());
    return true;
}

// Decides whether guides pay, if that is known by now. Returns false if they do not.
bool GuideLearner::Decide(const Film& film) {
    std::vector<TileNoise> noise = learning.tally.Noise(film);
    const GuideComparison c = learning.figures.comparison = learning.tally.Compare(noise);
    const double work = c.vertices * kVertexCost;
    if ((c.variance + 2 * c.error) * work < 1)
        learning.decided = learning.round;
    else if ((c.variance - 2 * c.error) * work > 1 || learning.round >= kLastDecision)
        return false;
    if (learning.decided > 0) {
        learning.noise = std::move(noise);
        learning.tally = {};
    } else {
        learning.tally.guided.assign(learning.tally.guided.size(), {});
    }
    return true;
}

bool GuideLearner::Learn(const Film& film) {
    if (IsTrial() && learning.round >= kFirstDecision && !Decide(film))
        return Finish(false, "variance times work is not significantly below that without guiding");
    GuideFigures& figures = learning.figures;
    const bool isUsed = options.mode == GuideMode::On || learning.decided > 0;
    const int most = options.isShort ? kMostWithClock : kMost;
    const bool isLast = isUsed && (learning.paths >= kPathsEnough || figures.samples >= most);
    // The old state and the new exist at the same time. The best fraction of guided paths is known
    // only for a guide that has been used.
    const double millions = double(learning.paths) / double(1 << 20);
    const RefineOptions refine{.leafVertices = kLeafVertices * std::sqrt(std::max(1., millions)),
                               .maxBytes = (size_t(options.megabytes) << 20) / 2,
                               .knowsFractions = learning.round > 1};
    if (isLast)
        learning.guide = FreezeGuide(learning.state, refine);
    else
        learning.state = Refine(learning.state, refine);
    const Guide& guide = isLast ? learning.guide : learning.state.guide;
    figures.isUsed = isUsed;
    figures.bytes = int64_t(guide.Bytes());
    figures.leaves = int(guide.leaves.size());
    figures.why = options.mode == GuideMode::On ? "as asked for"
                  : isUsed ? "variance times work is below that without guiding"
                           : "too few samples to decide";
    return !isLast || Finish(true, figures.why);
}

bool GuideLearner::Finish(bool isUsed, const std::string& why) {
    learning.figures.isUsed = isUsed;
    learning.figures.why = why;
    learning.state = {};
    learning.tally = {};
    learning.end = kNoRoundEnd;
    return false;
}

void GuideLearner::SetPaths() {
    paths = Estimator::Combined;
    if (learning.IsDone()) {
        if (learning.figures.isUsed) paths = learning.guide;
    } else if (learning.round > 0) {
        paths = learning.state.guide;
        paths.record = &learning.state.record;
        paths.usual = float(learning.usual);
    }
    SetDirectLight(&learning.directLight, &paths.learned);
}

std::vector<std::byte> GuideLearner::Save() const { return SaveLearning(learning); }

void GuideLearner::Take(std::span<const std::byte> bytes, const Film& film) {
    Learning taken = RestoreLearning(bytes);
    const bool isAuto = options.mode == GuideMode::Auto;
    const bool compares = isAuto && taken.round > 0 && taken.decided == 0 && !taken.IsDone();
    const size_t compared = compares ? film.TileCount() : 0;
    const size_t known = isAuto && taken.decided > 0 ? film.TileCount() : 0;
    if (taken.tally.unguided.size() != compared || taken.tally.guided.size() != compared ||
        taken.noise.size() != known)
        throw std::runtime_error("its guide is of another image");
    if (!Complete(scene, options.directLight, film.TileCount(), &taken.directLight))
        throw std::runtime_error("its learned direct light is of another image");
    learning = std::move(taken);
    SetPaths();
}

}  // namespace lull
