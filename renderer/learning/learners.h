// What a render learns from its own samples: a closed set of kinds.
//
// A render is cut into rounds. No block begins a pass of the next round before all active blocks
// have completed this one; then, with no thread at work, what was recorded in the round decides how
// the next one is sampled. So sample k of a pixel is a function of seed, pixel, index and what was
// learned from samples before k, and its expectation, given these, is unchanged: every sample
// counts, and the mean of all of them stays unbiased. What is learned depends on which blocks had
// stopped at the ends of rounds, and on nothing else: blocks stop by their own samples, and sums
// are integers.
//
// Each kind has
//
//   static bool IsWanted(const Scene&, const LearningOptions&)
//   Kind(const Scene&, const LearningOptions&, int64_t pixels)
//   int RoundEnd() const
//       the spp at which its round ends; kNoRoundEnd: it asks for no round
//   void Begin(const Schedule&)
//       is told the blocks that take part in the round that begins
//   SampleSpread* SpreadOf(Film*, const PixelRect& tile)
//       the counters to which samples of a tile are told in this round; null: none
//   void EndRound(Film*, const lull::RoundEnd&)
//       learns from the round if that is its own, and begins the next
//   void Apply(PathOptions*, PathRecords*)
//       lets the paths of the round sample as was learned, and be recorded
//   double Variance(const Film&, const PixelRect& part) const
//       of a sample, relative to one for which nothing was learned: in (0, 1]
//   void Describe(GuideFigures*) const
//   void Put(StateWriter*) const
//   void Get(StateReader*, const Film&)
//       the state, to continue to the same bits; throws std::runtime_error for damaged bytes, and
//       for a state of another scene, film or way to learn
#pragma once

#include "renderer/base/optional_kinds.h"
#include "renderer/learning/direction_learner.h"
#include "renderer/learning/light_learner.h"
#include "renderer/learning/strategy_learner.h"

namespace lull {

// Learns in the course of a render (RenderContext::learners), and has the options of its paths.
class Learners {
  public:
    // Makes those that are wanted for a film of so many pixels. The scene must outlive them.
    Learners(const Scene&, const LearningOptions&, int64_t pixels);
    Learners(const Learners&) = delete;
    Learners& operator=(const Learners&) = delete;

    bool IsEmpty() const { return AreAllMissing(kinds); }
    // Return the options of this round's paths, what learns from them, and the spp at which it
    // ends: no block goes beyond it before EndRound(). kNoRoundEnd: no kind asks for another round.
    const PathOptions& Paths() const { return paths; }
    const PathRecords& Records() const { return records; }
    int RoundEnd() const;
    bool IsDone() const { return RoundEnd() == kNoRoundEnd; }

    // With no thread at work: begins a round, or again one that was interrupted.
    void Begin(const Schedule&);
    // Returns the present variance of a sample in a part of the film over that without anything
    // learned; 1 where that is not known.
    double Variance(const Film&, const PixelRect& part) const;

    // Returns the counters of this round's samples, by tiles of the film; null: none are needed.
    // Has to be asked once a pass, with no thread at work in that tile.
    SampleSpread* SpreadOf(Film*, const PixelRect& tile);
    // With no thread at work: learns from the round. If the render ends here, or is interrupted,
    // that is what whoever goes on from the checkpoint has to know, and no more.
    void EndRound(Film*, const lull::RoundEnd&);

    GuideFigures Figures() const;
    // Return and restore the state of learning, for a film with as many tiles. Take() throws
    // std::runtime_error for bytes that are not of Save().
    std::vector<std::byte> Save() const;
    void Take(std::span<const std::byte>, const Film&);

  private:
    void SetPaths();

    OptionalKinds<LightLearner, DirectionLearner, StrategyLearner> kinds;
    PathOptions paths = Estimator::Combined;
    PathRecords records;
    double seconds = 0;  // elapsed, between rounds
};

}  // namespace lull
