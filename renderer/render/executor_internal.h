// Carries out a schedule, on the threads of one process.
#pragma once

#include <tbb/enumerable_thread_specific.h>
#include <tbb/task_arena.h>
#include <tbb/task_group.h>

#include <atomic>
#include <chrono>
#include <deque>
#include <exception>
#include <functional>
#include <map>
#include <mutex>

#include "renderer/progress/forecast.h"
#include "renderer/render/render.h"
#include "stopping/base/parallel.h"

namespace lull {

// A schedule that threads share, with the state of its passes: a clock that can end them, earlier
// values of their pixels, and a viewer that shows where blocks have stopped.

struct BlockAnswer {
    bool stop = false;
    double noise = kUnknownNoise;
};

// Returns the spp at which the round of light paths ends; kNoRoundEnd: there are no rounds.
int LightRoundEnd(const RenderOptions&);

// Costs a lock a call, a few for each tile.
class LiveSchedule {
  public:
    // Begins where blocks are, `starts`; empty: from nothing. The options must outlive it.
    LiveSchedule(const RenderOptions&, std::span<const BlockStart> starts, RankTiles);

    // Gives out a tile; nothing if none is ready, or if the time is up. There are never more tasks
    // than tiles, but when time has been called.
    std::optional<Tile> Next();
    // Returns true if the tile was the last of its pass.
    bool Finish(const Tile&);
    // Returns how many tiles have become ready.
    int Decide(int block, const BlockAnswer&);
    int ReadyTiles();

    // Ends passes, but for those that have to come to their end.
    void CallTime();
    bool HasClock() const { return hasClock; }
    bool TimeCalled() const { return timeCalled; }
    // Returns whether no tile will be ready any more.
    bool IsOver();
    // Returns whether the round is over; begins the next, with no task at work.
    bool IsRoundOver();
    void BeginRound(int end);

    // Calls look(schedule) while nothing changes.
    template <typename Look>
    auto Locked(const Look& look) {
        std::lock_guard lock(mutex);
        return look(static_cast<const Schedule&>(schedule));
    }

    // With no task at work: restarts from the given state of blocks, so that passes under way are
    // given out again, in which complete pixels keep their samples; and restores the samples before
    // passes for which the time did not suffice. Undo() returns their blocks.
    void Restart(std::span<const BlockStart> starts, RankTiles);
    std::vector<int> Undo();

    // Return the schedule without a lock: with no task at work, or for constant parts: positions of
    // blocks and, after the last tile of a pass and before the decision, that block.
    const Schedule& Unlocked() const { return schedule; }
    const Block& BlockAt(int i) const { return schedule.Blocks()[size_t(i)]; }
    const RankTiles& Share() const { return share; }
    std::vector<PixelRect> TilesOfRank(int block, int rank) const;

  private:
    // The pixels of a block whose pass is under way. A pass is undone as a whole, so that all
    // pixels of a block have the same samples.
    struct Before {
        std::vector<PixelRect> tiles;
        std::vector<std::byte> planes;  // tile by tile, by PutPlanes()
    };

    void Keep(int block);
    void ShowStops();

    const RenderOptions& options;
    RankTiles share;
    const bool hasClock;

    std::mutex mutex;  // guards the members below
    Schedule schedule;
    std::map<int, Before> undo;  // for renders that have a clock
    bool timeCalled = false;
    std::vector<char> shownStops;  // blocks that were said to have stopped
};

// Asks the criteria of blocks after each pass.

struct BlockCheck {
    BlockAnswer answer;
    Decision decision;  // of the criterion, which may not have checked the block
    std::optional<double> networkNoise = {};  // Criterion::NetworkNoise()
    double seconds = 0;  // of processors, that it took, the view of the pixels included
};

// Nobody else touches a block between the end of its pass and the decision, so that blocks can be
// checked at the same time without locks.
class BlockCriteria {
  public:
    // Makes the criteria of voting blocks, as a render has left them. The options must outlive it.
    BlockCriteria(const RenderOptions&, std::span<const Block> blocks);

    // Returns the inputs of criterion and clock for a block.
    ViewNeed NeedAt(int block, int spp) const;
    // Checks a block whose pass has come to `spp`, and whose samples took `seconds` so far.
    // `complete`, if any, fills in the pixels of the view that other ranks have rendered.
    BlockCheck Check(int index, const Block&, int spp, double seconds,
                     const std::function<void(int block, FilmView*)>& complete);
    // Returns the states of the criteria, for checkpoints.
    std::vector<std::vector<std::byte>> Save() const;

  private:
    BlockView ViewOf(int index, const Block&, ViewNeed,
                     const std::function<void(int block, FilmView*)>& complete);

    const RenderOptions& options;
    const bool hasClock;
    std::vector<std::unique_ptr<Criterion>> criteria;  // null for blocks that do not vote
    tbb::enumerable_thread_specific<FilmView> views;
};

// Returns the most samples that a pixel has.
int MostSamples(const PixelRect&, const Film&);

// Return where blocks are, given or left by an interrupted render; with a clock, also how noisy.
std::vector<BlockStart> StartsOf(std::span<const BlockResult> blocks, const RenderOptions&);
std::vector<BlockStart> StartsOf(const RenderOptions&);

// Runs the tasks of a render: identical ones for tiles, and single works such as decisions.

// The thread sanitizer sees the order that a mutex gives, but not the order of tasks within oneTBB:
// hence the first thing that a task reads is a TaskOrder.
class TaskSet {
  public:
    // Exceptions of tasks go to `take`, or where that is empty to Wait().
    TaskSet(std::function<void()> doTile, std::function<void(std::exception_ptr)> take)
        : doTile(std::move(doTile)), take(std::move(take)) {}

    void Spawn(int count) {
        open += count;
        tileTask.order.Leave();
        for (int i = 0; i < count; ++i) group.run(std::ref(tileTask));
    }
    // Has `work` done in the arena, from another thread.
    void Enqueue(tbb::task_arena* arena, std::function<void()> work) {
        {
            std::lock_guard lock(worksMutex);
            works.push_back(std::move(work));
        }
        ++open;
        workTask.order.Leave();
        arena->enqueue(group.defer(std::ref(workTask)));
    }
    void Wait() {
        group.wait();
        tileTask.order.Enter();
    }
    bool IsIdle() const { return open == 0; }

  private:
    struct TileTask {
        TaskSet* set;
        TaskOrder order = {};
        void operator()() {
            order.Enter();
            set->Guarded(set->doTile);
            order.Leave();
        }
    };
    struct WorkTask {
        TaskSet* set;
        TaskOrder order = {};
        void operator()() {
            order.Enter();
            set->tileTask.order.Enter();
            std::function<void()> work;
            {
                std::lock_guard lock(set->worksMutex);
                work = std::move(set->works.front());
                set->works.pop_front();
            }
            set->Guarded(work);
            set->tileTask.order.Leave();
        }
    };

    void Guarded(const std::function<void()>& work) {
        struct Leaving {
            std::atomic<int>& open;
            ~Leaving() { --open; }
        } leaving{open};
        try {
            work();
        } catch (...) {
            if (!take) throw;
            take(std::current_exception());
        }
    }

    const std::function<void()> doTile;
    const std::function<void(std::exception_ptr)> take;
    TileTask tileTask{this};
    WorkTask workTask{this};
    std::atomic<int> open = 0;  // tasks that have not come to their end
    std::mutex worksMutex;      // guards `works`
    std::deque<std::function<void()>> works;
    tbb::task_group group;
};

// Accounts of a render: cost and decisions of blocks, and progress.

// Cost of tiles: samples and wall-clock seconds.
struct TileEffort {
    int64_t samples = 0;
    double seconds = 0;
};

// Costs a lock a tile.
class ProgressLedger {
  public:
    // Goes on with the books of an interrupted render and its film. The options must outlive it.
    ProgressLedger(const RenderOptions&, size_t blocks);

    // Returns the seconds since the start, of the runs before this one as well.
    double Seconds() const;

    // Notes a tile rendered here, with its CPU time, and the part of a block from another rank.
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

    const RenderOptions& options;
    const Clock::time_point start = Clock::now();
    // Of the runs before this one: wall-clock time, CPU time of samples, and samples.
    const double secondsBefore, spentBefore;
    const int64_t samplesBefore;

    // Guards the members below, but criteria's seconds and decisions in `results`.
    std::mutex mutex;
    std::vector<BlockResult> results;
    std::vector<StopTrend> trends;  // of the blocks; empty: nothing is predicted
    int64_t samples;
    TileEffort effort;

    std::mutex reportMutex;  // guards `nextReport`, and lets one thread report at a time
    double nextReport = 0;
};

// Overrides for one of several ranks, called from tasks; empty: as for a process alone.
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
    // The options must outlive it.
    Executor(const RenderOptions&, std::span<const BlockStart> starts, RankTiles = {},
             RankHooks = {});

    RenderResult Run();

    // Asks the criterion and returns how many tiles have become ready.
    int DecideBlock(int block);
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
    // With no task at work: write the state, show how far it is, and return the result.
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

    const RenderOptions& options;
    const RankHooks hooks;
    bool isLastRound = false;  // the cap cuts it short: the checkpoint is of before
};

// Returns whether the state has the blocks that the schedule will make of the region.
bool HasBlocksOf(const RenderState&, const PixelRect& region, const ScheduleOptions&);

}  // namespace lull
