// Carries out a schedule, on the threads of one process.
#pragma once

#include <atomic>

#include "renderer/render/progress_ledger_internal.h"
#include "renderer/render/task_set_internal.h"

namespace lull {

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
