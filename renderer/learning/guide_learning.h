// Learns where light comes from, from the image's own samples.
//
// A render is cut into rounds. No block begins a pass of the next round before all active blocks
// have completed this one; then, with no thread at work, the record of the round becomes the next
// guide. So sample k of a pixel is a function of seed, pixel, index and the guide learned from
// samples before k, and its expectation, given these, is unchanged: every sample counts, and the
// mean of all of them stays unbiased. A guide depends on which blocks had stopped at the ends of
// rounds, and on nothing else: blocks stop by their own samples, and sums are integers.
//
// `on` records from 4 spp on, in rounds of 4, 8, 16, ... spp, the first of them without a guide.
// `auto` begins late, so that blocks that stop early do not pay for it, with short rounds: one
// without a guide, the others with. It keeps the guide once a round had significantly less
// variance, times its vertices, than the first, and drops it once that is significantly not so, or
// undecided after a few rounds. Before that it learns the light that arrives directly from lights
// (direct_light_learning.h).
#pragma once

#include <optional>
#include <string>

#include "renderer/base/enum_names.h"
#include "renderer/guiding/guide_refine.h"
#include "renderer/learning/direct_light_learning.h"
#include "renderer/learning/guide_tally.h"
#include "renderer/schedule/schedule.h"
#include "renderer/transport/integrator.h"

namespace lull {

// Whether paths are guided: never; where that was seen to pay; always.
enum class GuideMode { Off, Auto, On };

template <>
struct EnumNames<GuideMode> {
    static constexpr std::pair<GuideMode, const char*> all[] = {
        {GuideMode::Off, "off"}, {GuideMode::Auto, "auto"}, {GuideMode::On, "on"}};
};

// Results and decisions of learning, for reports.
struct GuideFigures {
    bool isUsed = false;
    std::string why;             // it is used, or not
    int rounds = 0;              // that were recorded
    int from = 0;                // samples per pixel, from which on paths were recorded
    int samples = 0;             // per pixel, that were recorded
    int64_t bytes = 0;           // of the guide
    int leaves = 0;              // of its tree over space
    double seconds = 0;          // elapsed, between rounds
    GuideComparison comparison;  // of auto
    // Learned sampling of lights, of auto, where it has decided: relative to that without.
    std::optional<GuideComparison> directLight;
    bool usesDirectLight = false;
};

// Options of path guiding.
struct GuideOptions {
    GuideMode mode = GuideMode::Off;
    int megabytes = 64;  // that trees and sums may take, > 0
};

struct LearningOptions {
    GuideMode mode = GuideMode::On;
    int megabytes = 64;  // that trees and sums may take, > 0
    // Learning shall not take long: blocks of a render that has a clock do not wait for each other.
    bool isShort = false;
    bool directLight = false;  // learns sampling of lights, too; needs LearnsDirectLight()
};

// All that is needed to continue learning, to the same bits.
struct Learning {
    int round = 0;        // 0: nothing was recorded yet
    int decided = 0;      // of auto: the round after which it was known that guides pay; 0: none
    int end = 0;          // of the round, in samples per pixel; kNoRoundEnd: learning is done
    double usual = 0;     // mean luminance of the image
    int64_t paths = 0;    // that were recorded
    int64_t samples = 0;  // of the film when the round began
    GuideState state;     // empty while nothing is recorded
    Guide guide;          // when learning is done and it is to be used
    GuideTally tally;     // of auto, until it has decided
    std::vector<TileNoise> noise;  // of the tally then, where guides pay
    GuideFigures figures;
    DirectLightLearning directLight;

    bool IsDone() const { return end == kNoRoundEnd; }  // of the guide
};

// Returns whether paths of the scene can be guided; if not, why.
std::optional<std::string> WhyNotGuided(const Scene&, Estimator);

// Returns a summary of learning, in one line.
std::string TextOf(const GuideFigures&, GuideMode);

// Learns in the course of a render (RenderOptions::learner), and has the options of its paths.
class GuideLearner {
  public:
    // The scene, of which WhyNotGuided() says nothing unless the mode is Off, must outlive it.
    GuideLearner(const Scene&, const LearningOptions&, int64_t pixels);
    GuideLearner(const GuideLearner&) = delete;
    GuideLearner& operator=(const GuideLearner&) = delete;

    // Return the options of this round's paths, and the spp at which it ends: no block goes beyond
    // it before EndRound(). kNoRoundEnd: there are no more rounds.
    const PathOptions& Paths() const { return paths; }
    int RoundEnd() const { return std::min(learning.end, learning.directLight.end); }
    bool IsDone() const { return RoundEnd() == kNoRoundEnd; }

    // Returns the present variance of a sample in a part of the film over that without a guide, see
    // VarianceOf(); 1 where that is not known, as with `on`.
    double Variance(const Film&, const PixelRect& part) const;

    // Returns the counters of this round's samples, by tiles of the film; null: none are needed.
    // Has to be asked once a pass, with no thread at work in that tile.
    SampleSpread* SpreadOf(const Film&, const PixelRect& tile);
    // With no thread at work: learns from the round, and begins the next.
    void EndRound(const Film&);

    const GuideFigures& Figures() const { return learning.figures; }
    // Return and restore the state of learning, for a film with as many tiles. Take() throws
    // std::runtime_error for bytes that are not of Save().
    std::vector<std::byte> Save() const;
    void Take(std::span<const std::byte>, const Film&);

  private:
    void EndGuideRound(const Film&);
    bool Begin(const Film&);
    bool Learn(const Film&);
    bool IsTrial() const;
    bool Decide(const Film&);
    int RoundLength(int round) const;
    bool Finish(bool isUsed, const std::string& why);
    void SetPaths();

    const Scene& scene;
    const LearningOptions options;
    const int pace;  // samples per pixel of a round of auto
    Learning learning;
    PathOptions paths = Estimator::Combined;
};

}  // namespace lull
