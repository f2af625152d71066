// Learns the directions that light comes from.
//
// `on` records from 4 spp on, in rounds of 4, 8, 16, ... spp, the first of them without a guide.
// `auto` begins late, so that blocks that stop early do not pay for it, with short rounds: one
// without a guide, the others with. It keeps the guide once a round had significantly less
// variance, times its vertices, than the first, and drops it once that is significantly not so, or
// undecided after a few rounds. Before that the light that arrives directly from lights is learned
// (light_learner.h).
#pragma once

#include "renderer/guiding/guide_refine.h"
#include "renderer/learning/learning.h"
#include "renderer/learning/rounds.h"

namespace lull {

// A kind of learner (learners.h).
class DirectionLearner {
  public:
    // The first and the last round after which `auto` can decide.
    static constexpr int kFirstDecision = 3, kLastDecision = 7;

    // Needs a scene of which WhyNotGuided() says nothing.
    static bool IsWanted(const Scene&, const LearningOptions& options) {
        return options.mode != GuideMode::Off;
    }
    DirectionLearner(const Scene&, const LearningOptions&, int64_t pixels);

    int RoundEnd() const { return rounds.end; }
    void Begin(const Schedule&) {}
    SampleSpread* SpreadOf(Film*, const PixelRect& tile);
    void EndRound(Film*, const lull::RoundEnd&);
    void Apply(PathOptions*, PathRecords*);
    double Variance(const Film& film, const PixelRect& part) const {
        return VarianceOf(trial.noise, film, part);
    }
    void Describe(GuideFigures*) const;
    void Put(StateWriter*) const;
    void Get(StateReader*, const Film&);

  private:
    bool BeginToRecord(const Film&);
    bool Learn(const Film&);
    bool IsTrial() const {
        return options.mode == GuideMode::Auto && decided == 0 && rounds.Record();
    }
    int RoundLength(int round) const;
    bool Finish(bool isUsed, const std::string& why);

    const Scene* scene;
    LearningOptions options;
    int pace;  // samples per pixel of a round of auto

    Rounds rounds;
    int decided = 0;      // of auto: the round after which it was known that guides pay; 0: none
    double usual = 0;     // mean luminance of the image
    int64_t paths = 0;    // that were recorded
    int64_t samples = 0;  // of the film when the round began
    GuideState state;     // empty while nothing is recorded
    Guide guide;          // when learning is done and it is to be used
    Trial trial;          // of auto
    GuideFigures figures;
};

}  // namespace lull
