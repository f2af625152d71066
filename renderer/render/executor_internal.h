// Carries out a schedule, on the threads of one process.
#pragma once

#include <tbb/enumerable_thread_specific.h>
#include <tbb/task_group.h>

#include <atomic>
#include <chrono>
#include <mutex>

#include "renderer/render/forecast.h"
#include "renderer/render/render.h"
#include "renderer/render/undo.h"
#include "stopping/base/parallel.h"

namespace lull {

// One task for each tile that is ready, each of which takes whatever tile is due when it starts.
// The last tile of a pass asks the criterion and spawns the block's next pass, so no block ever
// waits for another, and a single block still fills every core.
class Executor {
  public:
    Executor(const SampleSource&, const RenderOptions&, Film*, const RenderState* interrupted);
    virtual ~Executor() = default;

    // Says whether the state has the blocks that the schedule will make of the region.
    static bool Fits(const RenderState&, const PixelRect& region, const ScheduleOptions&);

    RenderResult Run();

  protected:
    using Clock = std::chrono::steady_clock;

    // Is what is said of a block after a pass.
    struct Judgement {
        bool stop = false;
        double noise = unknownNoise;
    };

    // For one of several ranks: takes the tiles of the share. `starts` is where blocks are.
    Executor(const SampleSource&, const RenderOptions&, Film*, const RenderState* interrupted,
             std::span<const BlockStart> starts, TileShare);

    // Begins anew where blocks are now, with no task at work: passes under way are given out once
    // more, of which pixels keep what they have.
    void Restart(std::span<const BlockStart> starts, TileShare);
    // Returns where blocks are, with no task at work.
    std::vector<BlockStart> Starts();

    // What is different with several ranks: what follows on the last tile of a pass, what is known
    // of a block's pixels, what a decision leads to, and whether an exception is taken care of.
    virtual void OnPassEnd(int block) { Spawn(DecideBlock(block)); }
    virtual void CompleteView(int, FilmView*) {}
    virtual void OnDecided(int, const Judgement&) {}
    virtual bool TakeException(std::exception_ptr) { return false; }

    void Spawn(int count);
    // Asks the criterion and returns how many tiles have become ready.
    int DecideBlock(int block);
    // Says where a decision leads to; returns how many tiles have become ready.
    int Decide(int block, const Judgement&);
    void CallTime();
    // Forgets the samples of passes that the time did not suffice for.
    void Undo();
    RenderState State();
    RenderResult Result();
    ViewNeed NeedAt(int block, int spp) const;
    void ReportProgress();
    bool IsCancelled() const {
        return peerInterrupted || (options.isCancelled && options.isCancelled());
    }
    double Seconds() const;

    const SampleSource& source;
    const RenderOptions& options;
    Film* film;
    TileShare share;
    const Clock::time_point start = Clock::now();
    const double secondsBefore;         // of the runs before this one
    std::atomic<bool> pausing = false;  // takes no more tiles, for a checkpoint
    std::atomic<bool> peerInterrupted = false;
    double nextCheckpoint = 0;
    const bool hasClock;

    // Guards the schedule, `trends`, `samples`, the tiles' seconds in `results`, `undo`, `effort`,
    // `shownStops`.
    std::mutex mutex;
    Schedule schedule;
    std::vector<BlockResult> results;
    std::vector<std::unique_ptr<Criterion>> criteria;  // null for blocks that do not vote
    std::vector<StopTrend> trends;                     // of the blocks; empty: nothing is predicted
    int64_t samples;
    // What tiles took here since it was last looked at; seconds as clocks have it.
    struct Effort {
        int64_t samples = 0;
        double seconds = 0;
    };
    Effort effort;
    PassUndo undo;                 // for renders that have a clock
    bool timeCalled = false;       // it has run down
    std::vector<char> shownStops;  // blocks that the display knows to have stopped

    std::mutex progressMutex;  // guards `nextProgress`, and lets one thread report at a time
    double nextProgress = 0;

    tbb::enumerable_thread_specific<FilmView> views;

    // Is what all tasks do, and holds their order, so that the first thing they read is this.
    struct Task {
        Executor* executor;
        TaskOrder order = {};
        void operator()();
    };
    Task task{this};
    tbb::task_group group;

  private:
    void RunTile();
    void RunTile(const Tile&);
    int64_t TakeSamples(const Tile&);
    void ShowStops();
    std::optional<Tile> TakeTile();
    bool FinishTile(const Tile&, double seconds, const Effort& spent);
    std::vector<std::unique_ptr<Criterion>> MakeCriteria(const RenderState* interrupted) const;
    Judgement Judge(int block);
    BlockView ViewOf(int block, int spp);
    std::vector<StopTrend> MakeTrends() const;
    RenderProgress CurrentProgress() const;
    void Predict(RenderProgress*) const;
    void NoteBlocks();
};

// Says where blocks are that an interrupted render has left; with a clock, also how noisy.
std::vector<BlockStart> StartsOf(std::span<const BlockResult> blocks, bool hasClock, const Film&);
std::vector<BlockStart> StartsOf(const RenderState* interrupted, bool hasClock, const Film&);

}  // namespace lull
