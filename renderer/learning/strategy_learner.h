// Learns how many samples the strategies of bidirectional path tracing take, from the variance that
// they had in the round before, as in stratified sampling (Neyman 1934): in proportion to the root
// of the variance over the cost.
#pragma once

#include "renderer/film/film.h"
#include "renderer/learning/learning.h"
#include "renderer/learning/rounds.h"
#include "stopping/base/state.h"

namespace lull {

// A kind of learner (learners.h). Its rounds are those of the light paths; the film keeps its
// spreads, so that they are with its samples wherever these go.
class StrategyLearner {
  public:
    // With few connections the weights leave to other strategies all that these can find as well:
    // only the rest makes them more.
    static constexpr BdptShares kFirst{.lightPaths = 0.3f, .connections = 0.05f};
    // Shares below which no strategy falls: it has to be seen where it would bring much.
    static constexpr BdptShares kLeast{.lightPaths = 0.05f, .connections = 0.03f};

    static bool IsWanted(const Scene& scene, const LearningOptions&) {
        return IsBidirectional(scene.integrator);
    }
    StrategyLearner(const Scene&, const LearningOptions&, int64_t pixels) : pixels(pixels) {}

    int RoundEnd() const { return kNoRoundEnd; }
    // Light paths are the fewer, the fewer pixels are left that wait for them.
    void Begin(const Schedule&);
    SampleSpread* SpreadOf(Film* film, const PixelRect& tile) { return film->SpreadOf(tile); }
    // Learns from every round, and lets the film forget the spreads.
    void EndRound(Film*, const lull::RoundEnd&);
    void Apply(PathOptions* paths, PathRecords*) const { paths->shares = ofRound; }
    double Variance(const Film&, const PixelRect&) const { return 1; }
    void Describe(GuideFigures*) const {}
    void Put(StateWriter* writer) const { writer->Put(shares); }
    void Get(StateReader*, const Film&);

  private:
    const int64_t pixels;
    BdptShares shares = kFirst;  // for all pixels
    BdptShares ofRound = kFirst;
};

}  // namespace lull
