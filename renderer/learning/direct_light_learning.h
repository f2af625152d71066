// Learns how much light each light, and each tile of the environment map, brings to a place, from
// the image's own samples, in rounds as guide_learning.h has them.
//
// After 16 spp, a round of 8 spp records samples of the scene's own distributions. Rounds of 8,
// 16 and 16 spp are sampled as was learned, and record, too. Sampling stays as learned if the
// last one had significantly less variance than the first, for the cost of a sample.
#pragma once

#include "renderer/film/film.h"
#include "renderer/guiding/environment_guide.h"
#include "renderer/guiding/light_choice_guide.h"
#include "renderer/learning/guide_tally.h"
#include "renderer/schedule/schedule.h"
#include "renderer/transport/integrator.h"
#include "stopping/base/state.h"

namespace lull {

// All that is needed to continue learning, to the same bits. Guides and records are empty before
// the first record and where they are not used, records also when learning is done.
struct DirectLightLearning {
    int round = 0;          // 0: nothing was recorded yet
    int end = kNoRoundEnd;  // of the round, in spp; kNoRoundEnd: learning is done
    LightChoiceGuide lights;
    LightChoiceRecord lightRecord;  // of all that has been found so far
    double usual = 1;               // mean luminance of the image after round 0
    EnvironmentState environment;   // its record: likewise
    GuideTally tally;               // until it has decided
    std::vector<TileNoise> noise;   // of the tally then, where learned sampling is used
    bool isUsed = false;
    GuideComparison comparison;  // with samples without, when that is known

    bool IsDone() const { return end == kNoRoundEnd; }
};

// Returns whether direct light of the scene can be learned: paths start at the camera alone, lights
// are not sampled as by pbrt-v3, and the scene has an environment map or several lights that are
// chosen by tables of places.
bool LearnsDirectLight(const Scene&, Estimator);

// Begins to learn.
DirectLightLearning BeginDirectLight();
// With no thread at work: learns from the round, and begins the next.
void EndDirectLightRound(const Scene&, const Film&, DirectLightLearning*);

// Returns the counters of the round's samples by tiles of the film; null: none are needed.
std::vector<SampleSpread>* SpreadsOf(DirectLightLearning*);

// Lets paths sample as was learned, and record.
void SetDirectLight(DirectLightLearning*, LearnedLight*);

// Write and read its state. GetDirectLight() throws std::runtime_error for damaged bytes.
void PutDirectLight(const DirectLightLearning&, StateWriter*);
DirectLightLearning GetDirectLight(StateReader*);
// Adds the scene's voxels to a state that was read. Returns false if it is not one of this scene,
// a render that `learns` direct light, and a film of as many tiles.
bool Complete(const Scene&, bool learns, size_t tiles, DirectLightLearning*);

}  // namespace lull
