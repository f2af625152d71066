// Renders blocks pass by pass, each until its own stopping criterion says that it is done.
#pragma once

#include <functional>

#include "renderer/film/display.h"
#include "renderer/film/film.h"
#include "renderer/progress/progress.h"
#include "renderer/schedule/schedule.h"
#include "renderer/transport/integrator.h"
#include "stopping/rules/rule.h"

namespace lull {

struct BlockDecision {
    int spp;
    Decision decision;
    std::optional<double> networkNoise = {};  // Criterion::NetworkNoise(), for forecasts
};

struct BlockResult {
    Block block;
    double seconds = 0;  // of processors, spent on its samples
    // Spent on its criterion and, with a clock, on its noise, the view of the pixels included.
    double criterionSeconds = 0;
    std::vector<BlockDecision> decisions;  // those for which the block was checked
};

// With the film, all that is needed to continue a render: the pixels will be the
// same bits as without the interruption. A pass may be under way, for some of its pixels.
struct RenderState {
    std::vector<BlockResult> blocks;
    // Of each block, as Criterion::Save() has it; empty: all begin again.
    std::vector<std::vector<std::byte>> criteria;
    double seconds = 0;  // since the start of the first run
    // What light rounds have learned; nothing: there are none, or they begin again.
    std::optional<BdptShares> shares = {};
};

struct RenderResult;

// Callbacks of a running render. Each can be empty.
struct RenderEvents {
    // Progress, from one thread at a time, about every `progressInterval` seconds and at the
    // end.
    std::function<void(const RenderProgress&)> onProgress;
    double progressInterval = 0.25;
    // A block that stops, or is at the cap; from any thread, one at a time.
    std::function<void(int index, const Block&)> onStop;
    // The result so far, with no thread at work and all samples in the film, every
    // `previewInterval` seconds. Empty for all ranks, or for none.
    std::function<void(const RenderResult&)> onPreview;
    double previewInterval = 60;
    // Ranks that do not answer, once the render has been cancelled.
    std::function<void(const std::vector<int>& ranks)> onSilence;
    // A rank that was given up, and for how many seconds it was silent.
    std::function<void(int rank, double seconds)> onGivenUp;

    // Of a Session: the progress when it ended, of the first rank alone; and lines on the
    // checkpoint resumed, and on checkpoints that could not be written.
    std::function<void(const RenderProgress&)> onFinish;
    std::function<void(const std::string&)> onResume, onWarning;
};

class LightRounds;
class Peers;

// Takes a sample as RenderSample(); must depend on the sampler's seed, pixel and index alone.
using SampleSource = std::function<void(Sampler&, const Vec2i& pixel, uint32_t index, PathSample*)>;

// Saves the state of a render, to resume it after an interruption.
struct Checkpointing {
    // Called with the state, with no thread at work, every `interval` seconds and when cancelled.
    std::function<void(const RenderState&)> write = {};
    double interval = 60;
    bool atEnd = false;  // also when every block has stopped
};

// How to render, and at the end what, which a Session sets.
struct RenderOptions {
    ScheduleOptions schedule;
    Sampler sampler{SamplerKind::Sobol, 0};
    int threads = 0;  // 0: all

    // Makes each block's own stopping criterion; empty: all continue to the cap.
    CriterionMaker makeCriterion;
    // How the numbers in their decisions go, by which progress predicts the end, if given.
    std::optional<RuleTrend> trend;
    // Called before every tile; true ends the render after the tiles under way. Can be empty.
    std::function<bool()> isCancelled;
    RenderEvents events;
    // Receives every tile when it has been rendered, and every block that stops. Null: none.
    Display* display = nullptr;

    // The processes that share the work, of the same scene and options (peers.h). Null: none.
    Peers* peers = nullptr;
    // How long they render at least before tiles are dealt out by how fast they were.
    double dealInterval = 5;
    // For how many seconds rank 0 waits for a sign of life of another before it goes on without it;
    // with a clock a tenth of the time left, if that is less. Once the render has been cancelled,
    // and at the least, a twelfth of it.
    double rankPatience = 60;

    SampleSource source = {};
    Film* film = nullptr;
    // Where an interrupted render left film and state; null: from the start. A block whose
    // `stopped` is set in a state without samples is left out.
    const RenderState* interrupted = nullptr;
    // Traces light paths in rounds, for a film that keeps spreads (light_rounds.h). Null: none.
    LightRounds* lightRounds = nullptr;
    // A clock: returns the seconds that are left, and is called before every tile. Can be empty.
    // While it is positive, the block with the most visible noise (VisibleNoise() of baselines.h)
    // is given the next pass. Then the render ends after the tiles under way: passes that are not
    // complete by then are undone, but the first of each block is always completed. Decisions of
    // criteria do not depend on the clock.
    std::function<double()> secondsLeft = {};
    Checkpointing checkpoints = {};
};

struct RenderResult {
    std::vector<BlockResult> blocks;
    RenderProgress progress;          // at the end
    bool cancelled = false;           // before every block had stopped
    bool timeUp = false;              // the clock ended it before every block had stopped
    int threads = 0;                  // that it could use
    std::vector<double> shares = {};  // of the tiles, that ranks had in the end; empty: one rank
    RuleTrend trend = {};             // of the rule, where the options have it
};

// Renders the film's region. The pixels are the same bits for any number of threads and ranks
// and, at equal samples per pixel, for any size of blocks and length of passes. A clock changes
// nothing but the samples of blocks that have not stopped. Rethrows exceptions of criteria and
// callbacks; throws std::invalid_argument for a display on several ranks.
RenderResult Render(const RenderOptions&);

// Returns the scene as a source of samples, with a round's shares, if any; both must outlive it.
SampleSource SamplesOf(const Scene&, const PathOptions&, const LightRounds* = nullptr);

}  // namespace lull
