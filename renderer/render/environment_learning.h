// Learns which tiles of the environment map bring light to a place, from the image's own samples,
// in rounds as guide_learning.h has them.
//
// After 16 spp, a round of 8 spp records samples that are taken by power alone. Rounds of 8, 16 and
// 16 spp are sampled as was learned, and record, too. Sampling stays as learned if the last one had
// significantly less variance than the first, for the cost of a sample.
#pragma once

#include "renderer/film/film.h"
#include "renderer/guiding/environment_guide.h"
#include "renderer/render/guide_tally.h"
#include "renderer/render/schedule.h"
#include "renderer/transport/integrator.h"
#include "stopping/base/state.h"

namespace lull {

// All that is needed to continue learning, to the same bits.
struct EnvironmentLearning {
    int round = 0;                 // 0: nothing was recorded yet
    int end = kNoRoundEnd;         // of the round, in spp; kNoRoundEnd: learning is done
    EnvironmentState state;        // empty before the first record and where it is not used; its
                                   // record is empty when learning is done
    GuideTally tally;              // until it has decided
    std::vector<TileNoise> noise;  // of the tally then, where learned sampling is used
    bool isUsed = false;
    GuideComparison comparison;  // with samples taken by power, when that is known

    bool IsDone() const { return end == kNoRoundEnd; }
};

// Returns whether direct light of the scene can be learned: it has an environment map, which is not
// sampled as by pbrt-v3, and paths start at the camera alone.
bool LearnsEnvironment(const Scene&, Estimator);

// Begins to learn.
EnvironmentLearning BeginEnvironment();
// With no thread at work: learns from the round, and begins the next.
void EndEnvironmentRound(const Scene&, const Film&, EnvironmentLearning*);

// Returns the counters of the round's samples by tiles of the film; null: none are needed.
std::vector<SampleSpread>* SpreadsOf(EnvironmentLearning*);

// Lets paths sample as was learned, and record.
void SetEnvironment(EnvironmentLearning*, PathOptions*);

// Write and read its state. GetEnvironment() throws std::runtime_error for damaged bytes.
void PutEnvironment(const EnvironmentLearning&, StateWriter*);
EnvironmentLearning GetEnvironment(StateReader*);

}  // namespace lull
