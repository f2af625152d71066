// Learns how much light each light, and each tile of the environment map, brings to a place.
//
// After 16 spp, a round of 8 spp records samples of the scene's own distributions. Rounds of 8,
// 16 and 16 spp are sampled as was learned, and record, too. Sampling stays as learned if the
// last one had significantly less variance than the first, for the cost of a sample.
#pragma once

#include "renderer/guiding/environment_guide.h"
#include "renderer/guiding/light_choice_guide.h"
#include "renderer/learning/learning.h"
#include "renderer/learning/rounds.h"

namespace lull {

// Return whether a scene has what can be learned.
bool LearnsEnvironment(const Scene&);
bool LearnsLights(const Scene&);

// A kind of learner (learners.h). Guides and records are empty before the first record and where
// they are not used, records also when learning is done.
class LightLearner {
  public:
    static bool IsWanted(const Scene&, const LearningOptions& options) {
        return options.directLight;
    }
    LightLearner(const Scene&, const LearningOptions&, int64_t pixels);

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
    void Learn();
    void Finish();
    // Returns whether it has guides now.
    bool HasGuides() const { return rounds.IsDone() ? isUsed : rounds.round > 0; }

    const Scene* scene;
    Rounds rounds;
    LightChoiceGuide choices;
    LightChoiceRecord choiceRecord;  // of all that has been found so far
    double usual = 1;                // mean luminance of the image after round 0
    EnvironmentState environment;    // its record: likewise
    Trial trial;
    bool isUsed = false;
};

}  // namespace lull
