// Carries out a schedule, on the threads of one process.
#pragma once

#include <atomic>
#include <chrono>
#include <mutex>

#include "renderer/progress/forecast.h"
#include "renderer/render/block_criteria_internal.h"
#include "renderer/render/task_set_internal.h"

namespace lull {

// Accounts of a render: cost and decisions of blocks, and progress.

// Cost of tiles: samples and wall-clock seconds.
struct TileEffort {
    int64_t samples = 0;
    double seconds = 0;
};

// Costs a lock a tile.
class ProgressLedger {
  public:
    // Goes on with the books of an interrupted render, with the samples that the film has. Context
    // and options must outlive it.
    ProgressLedger(const RenderContext&, const RenderOptions&, size_t blocks);

    // Returns the seconds since the start, of the runs before this one as well.
    double Seconds() const;

    // Notes a tile that was rendered here, with its CPU time, and the part of a block that
    // another rank has rendered.
    void AddTile(int block, double processorSeconds, const TileEffort&);
    void AddPart(int block, double processorSeconds, int64_t samples);
    void AddCheck(int block, int spp, const BlockCheck&);

    // Return the accounts since the last call: of all tiles; the CPU time of a block.
    TileEffort TakeEffort();
    double TakeSeconds(int block);

    double SecondsOf(int block);
    int64_t Samples();
    // With no task at work, sets the samples to those that the film has after all.
    void SetSamples(int64_t);

    // Calls onProgress, if that is due, from one thread at a time.
    void Report(LiveSchedule*);
    // With no task at work, return the results of blocks, and of the render, so far.
    const std::vector<BlockResult>& Blocks(const Schedule&);
    RenderResult Result(const Schedule&);

  private:
    using Clock = std::chrono::steady_clock;

    RenderProgress Progress(const Schedule&);
    void Predict(const Schedule&, RenderProgress*) const;

    const RenderContext& context;
    const RenderOptions& options;
    const Clock::time_point start = Clock::now();
    // Of the runs before this one: wall-clock time, CPU time of samples, and samples.
    const double secondsBefore, spentBefore;
    const int64_t samplesBefore;

    // Guards the members below, except for criteria's seconds and decisions in `results`, which
    // belong to one thread at a time.
    std::mutex mutex;
    std::vector<BlockResult> results;
    std::vector<StopTrend> trends;  // of the blocks; empty: nothing is predicted
    int64_t samples;
    TileEffort effort;

    std::mutex reportMutex;  // guards `nextReport`, and lets one thread report at a time
    double nextReport = 0;
};

// Overrides for one of several ranks. All are called from tasks; empty: as for a
// process that is alone.
struct RankHooks {
    std::function<void(int block)> onPassEnd;                      // instead of the decision
    std::function<void(int block, FilmView*)> completeView;        // with pixels of other ranks
    std::function<void(int block, const BlockAnswer&)> onDecided;  // before it leads to anything
    std::function<void(std::exception_ptr)> onException;           // takes care of it
};

// One task for each tile that is ready, each of which takes whatever tile is due when it starts.
// The last tile of a pass asks the criterion and spawns the block's next pass, so no block ever
// waits for another, and a single block still fills every core.
class Executor {
  public:
    // `starts` is where blocks are, which an interrupted render has left or another rank has said.
    // Context and options must outlive it.
    Executor(const RenderContext&, const RenderOptions&, std::span<const BlockStart> starts,
             RankTiles = {}, RankHooks = {});

    // Renders all, with checkpoints, for a process that is alone.
    RenderResult Run();

    // Asks the criterion and returns how many tiles have become ready.
    int DecideBlock(int block);
    // Spawns the tiles that are ready.
    void SpawnReady() { tasks.Spawn(schedule.ReadyTiles()); }
    // With no task at work: begins a round of light paths, none of which are traced. Calls
    // `writeCheckpoint` before a round that the cap cuts short, after which none is written: with a
    // larger cap it would be longer, and whoever goes on begins it again.
    void BeginLightRound(const std::function<void()>& writeCheckpoint);
    // Lets no more tiles begin, and waits for those under way.
    void Quiesce();
    // Forgets the samples of passes that the time did not suffice for. Returns their blocks.
    std::vector<int> Undo();
    bool IsCancelled() const {
        return peerInterrupted || (options.isCancelled && options.isCancelled());
    }

    // Returns whether it is time for a pause, to write a checkpoint or to show a preview.
    bool IsPauseDue() const;
    // With no task at work: write the state, show how far it is, if it is time; and return the
    // result.
    void WriteCheckpoint();
    void ShowPreview(double pause);  // since these seconds of the render nothing works for it
    RenderResult Result();
    // Begins to count the seconds to the next of them.
    void RestartIntervals();

    LiveSchedule schedule;
    ProgressLedger ledger;
    BlockCriteria criteria;
    TaskSet tasks;
    std::atomic<bool> pausing = false;  // takes no more tiles
    std::atomic<bool> peerInterrupted = false;
    std::atomic<bool> isLightTraced = true;      // of the round, if there is any
    double nextCheckpoint = 0, nextPreview = 0;  // seconds, as the ledger has them

  private:
    // With no task at work: if a round is over, learns from it, begins the next and returns true.
    bool EndRound();
    void BeginLight();
    RenderState State();
    void RunTile();
    int64_t TakeSamples(const Tile&);

    const RenderContext& context;
    const RenderOptions& options;
    const RankHooks hooks;
    bool isLastRound = false;  // the cap cuts it short: the checkpoint is of before
};

// Returns whether the state has the blocks that the schedule will make of the region.
bool HasBlocksOf(const RenderState&, const PixelRect& region, const ScheduleOptions&);

}  // namespace lull
