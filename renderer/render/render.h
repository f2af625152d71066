// Renders blocks pass by pass, each until its own stopping criterion says that it is done.
#pragma once

#include <functional>

#include "renderer/film/display.h"
#include "renderer/film/layers.h"
#include "renderer/render/progress.h"
#include "renderer/render/schedule.h"
#include "stopping/rules/criterion.h"

namespace lull {

// Records what a criterion said of a block.
struct DecisionRecord {
    int spp;
    Decision decision;
};

struct BlockResult {
    Block block;
    double seconds = 0;  // of processors, spent on its samples
    // Spent on its criterion and, with a clock, on its noise, the view of the pixels included.
    double criterionSeconds = 0;
    std::vector<DecisionRecord> decisions;  // those for which the block was looked at
};

// Holds, together with the film, all that is needed to go on with a render: the pixels will be the
// same bits as without the interruption. A pass may be under way, for some of its pixels.
struct RenderState {
    std::vector<BlockResult> blocks;
    // Of each block, as Criterion::Save() has it; empty: all begin anew.
    std::vector<std::vector<std::byte>> criteria;
    double seconds = 0;  // since the start of the first run
};

class GuideLearner;
class Peers;
struct RenderResult;

struct RenderOptions {
    ScheduleOptions schedule;
    SamplerKind sampler = SamplerKind::Sobol;
    uint64_t seed = 0;
    int threads = 0;  // 0: all

    // Makes each block's own stopping criterion; empty: all go on to the cap.
    std::function<std::unique_ptr<Criterion>(const BlockInfo&)> makeCriterion;
    // How the numbers in their decisions go, from which progress predicts the end; nothing: it does
    // not.
    std::optional<RuleTrend> trend;
    // Is told how far things are, by one thread at a time, about every `progressInterval` seconds
    // and at the end. Can be empty.
    std::function<void(const RenderProgress&)> onProgress;
    double progressInterval = 0.25;
    // Is told of each block that stops, or is at the cap. Called from any thread, by one at a time.
    // Can be empty.
    std::function<void(int index, const Block&)> onStop;
    // Is shown the state of things, with no thread at work, every `checkpointInterval` seconds and
    // when the render is cancelled. Can be empty.
    std::function<void(const RenderState&)> onCheckpoint;
    double checkpointInterval = 60;
    bool checkpointAtEnd = false;  // also when every block has stopped
    // Is shown how far things are, with no thread at work and all samples in the film, every
    // `previewInterval` seconds. Can be empty; is so for all ranks, or for none.
    std::function<void(const RenderResult&)> onPreview;
    double previewInterval = 60;
    // Is asked before every tile; true ends the render after the tiles under way. Can be empty.
    std::function<bool()> isCancelled;
    // A clock: returns the seconds that are left, and is asked before every tile. Can be empty.
    // While it is positive, the block with the most visible noise (VisibleNoise() of lnoise.h) is
    // given the next pass. Then the render ends after the tiles under way: passes that are not
    // complete by then are undone, but the first of each block is always completed. What criteria
    // say of a block does not depend on the clock.
    std::function<double()> secondsLeft;
    // The processes that share the work, each with the same scene and options (peers.h). Null: this
    // one does all.
    Peers* peers = nullptr;
    // How long they render at least before tiles are dealt out by how fast they were.
    double dealInterval = 5;
    // Is told, once the render has been cancelled, of ranks that do not answer. Can be empty.
    std::function<void(const std::vector<int>& ranks)> onSilence;
    // For how many seconds rank 0 waits for a sign of life of another before it goes on without it;
    // with a clock a tenth of the time left, if that is less. Once the render has been cancelled,
    // and at the least, a twelfth of it.
    double rankPatience = 60;
    // Is told of a rank that was given up, and for how many seconds it was silent. Can be empty.
    std::function<void(int rank, double seconds)> onGivenUp;

    // Learns from the samples, in rounds, of which the source heeds what it has learned
    // (guide_learning.h). Null: nothing is learned.
    GuideLearner* learner = nullptr;

    // What is collected beside the film, from the same samples; they are the same bits with it.
    Layers layers;
    // Is shown every tile when it has been rendered, and every block that stops. Null: none.
    Display* display = nullptr;
};

struct RenderResult {
    std::vector<BlockResult> blocks;
    RenderProgress progress;          // at the end
    bool cancelled = false;           // before every block had stopped
    bool timeUp = false;              // the clock ended it before every block had stopped
    int threads = 0;                  // that it could use
    std::vector<double> shares = {};  // of the tiles, that ranks had in the end; empty: one rank
};

// Takes sample `index` of a pixel; must depend on nothing but the sampler's seed, pixel and index.
using SampleSource = std::function<PathSample(Sampler&, const Vec2i& pixel, uint32_t index)>;

// Renders the film's region, from the start or from where an interrupted render left film, layers
// and state. The pixels are the same bits for any number of threads and ranks and, at equal samples
// per pixel, for any size of blocks and length of passes. A clock decides how many samples blocks
// get that have not stopped, and nothing else. Passes on what criteria and callbacks throw; throws
// std::invalid_argument for layers of another region, and for a display on several ranks.
//
// A block whose `stopped` is set in a state without samples is left out.
RenderResult Render(const SampleSource&, const RenderOptions&, Film*,
                    const RenderState* interrupted = nullptr);

// Returns the scene as a source of samples; it, and the guide if there is one, must outlive the
// source.
SampleSource SamplesOf(const Scene&, const PathOptions&);
// The same, traced as the learner says at the time, which must outlive it too.
SampleSource SamplesOf(const Scene&, const GuideLearner&);

// Return the same samples with what they have met first, as far as layers that are wanted need it.
AovSource AovSamplesOf(const Scene&, PathOptions, const AovSet& wanted);
AovSource AovSamplesOf(const Scene&, const GuideLearner&, const AovSet& wanted);

}  // namespace lull
