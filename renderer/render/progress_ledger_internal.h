// Accounts of a render: cost and decisions of blocks, and progress.
#pragma once

#include <chrono>
#include <mutex>

#include "renderer/progress/forecast.h"
#include "renderer/render/block_criteria_internal.h"

namespace lull {

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
    const double secondsBefore;  // of the runs before this one

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

}  // namespace lull
