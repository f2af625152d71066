// Learns where light comes from, in rounds over the whole image, before the image is rendered. The
// samples of the rounds are not those of the image, so that what was learned is independent of it
// and the mean stays what it is.
#pragma once

#include <functional>
#include <optional>
#include <string>

#include "renderer/guiding/guide_refine.h"
#include "renderer/render/render.h"

namespace lull {

// Whether paths are guided: never; where that was seen to pay; always.
enum class GuideMode { Off, Auto, On };

std::string NameOf(GuideMode);

// Says what was learned and decided, for reports.
struct GuideFigures {
    bool isUsed = false;
    std::string why;     // it is used, or not
    int rounds = 0;      // of learning
    int samples = 0;     // per pixel, for learning and for the decision
    int64_t bytes = 0;   // of the guide
    int leaves = 0;      // of its tree over space
    double seconds = 0;  // elapsed, in the run that came to the end of it
    // Of auto, guided over unguided, as guide_trial.h has them.
    double variance = 1, varianceError = 0, vertices = 1;
};

// What a render is asked for.
struct GuideOptions {
    GuideMode mode = GuideMode::Off;
    int megabytes = 64;  // that trees and sums may take, > 0
};

struct LearningOptions {
    GuideMode mode = GuideMode::On;
    int megabytes = 64;  // that trees and sums may take, > 0
    SamplerKind sampler = SamplerKind::Sobol;
    uint64_t seed = 0;
    int threads = 0;  // 0: all
    int cap = 10000;  // samples per pixel that the image has at most; learning takes a part of that
    // Is asked before every tile; true ends learning. Can be empty.
    std::function<bool()> isCancelled;
    // Is asked before every round but the first; true: there shall be no more. Can be empty.
    std::function<bool()> isEnough;
};

// Lets learning take a part of the time, of which `clock` returns the seconds that are left.
void HeedClock(const std::function<double()>& clock, LearningOptions*);

// Holds all that is needed to go on learning after a round, to the same bits.
struct Learning {
    int round = 0;     // the next one
    double usual = 0;  // mean luminance of the image
    GuideState state;  // empty before the first round and when learning is done
    bool isDone = false;
    Guide guide;  // when learning is done and it is to be used
    GuideFigures figures;
};

// Says whether paths of the scene can be guided; if not, why.
std::optional<std::string> WhyNotGuided(const Scene&, Estimator);

// Throws Error where the scene cannot be guided but `--guide on` asks for it.
void CheckGuide(const GuideOptions&, const Scene&, Estimator);

// Returns what there is instead of learning where paths are not guided, for that reason.
Learning NotGuided(const std::string& why);

// Says what came of learning, in a line.
std::string TextOf(const GuideFigures&, GuideMode);

// Learns until that is done. `onRound` is called after each round but the last, with no thread at
// work; it can be empty. Returns false if it was cancelled: `learning` is then not fit for use, and
// what `onRound` was shown last is what to go on from. The result is the same bits for any number
// of threads.
bool Learn(const Scene&, const PixelRect& region, const LearningOptions&, Learning* learning,
           const std::function<void(const Learning&)>& onRound = {});

}  // namespace lull
