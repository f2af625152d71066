// One of several ranks of a render (peers.h).
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "renderer/render/executor_internal.h"
#include "renderer/render/ranks/messages.h"

namespace lull {

// Decides which tiles each of several ranks renders, by how fast they are. Pure, without pixels.

// Returns the ranks in turn, each once.
std::vector<int> EvenDeal(int ranks);

// Returns a sequence in which each rank is as often as its speed asks for, but at least once, and
// evenly spread. Speeds are > 0, in any unit.
std::vector<int> DealBySpeed(const std::vector<double>& speeds);

// Records the work of ranks since the tiles were distributed.
class RankSpeeds {
  public:
    explicit RankSpeeds(int ranks) : efforts(size_t(ranks)) {}

    // `seconds` are those that the rank's threads took for their tiles, as clocks have it, divided
    // by the number of its threads.
    void Add(int rank, int64_t samples, double seconds);
    void Forget();

    // Returns samples a second of each rank; empty while one has done nothing, or the busiest has
    // not taken `leastSeconds`.
    std::vector<double> Speeds(double leastSeconds) const;

  private:
    struct Effort {
        int64_t samples = 0;
        double seconds = 0;
    };
    std::vector<Effort> efforts;
};

// Returns how many times as fast all ranks together would be if the tiles were dealt out by their
// speeds rather than by `deal`, which goes at the pace of the rank that has most to do for its
// speed. At least 1.
double GainOfDealing(const std::vector<double>& speeds, const std::vector<int>& deal);

// Has an executor, whose tasks are done by the threads of the arena, and a channel, by which the
// calling thread speaks with the other ranks.
class Rank {
  public:
    Rank(const RenderContext&, const RenderOptions&, tbb::task_arena*, RankHooks);

    // Runs `work` on a thread of the arena; its exceptions are thrown by the channel's Exchange().
    void Enqueue(std::function<void()> work) { executor.tasks.Enqueue(arena, std::move(work)); }
    void EnqueueReady() {
        Enqueue([this] { executor.SpawnReady(); });
    }
    // Returns the cost of the tiles here since the last call, in samples and seconds a thread.
    TileEffort TakeEffort();
    // Returns the tiles of a block that a rank has by this deal and did not have by the one before;
    // all where that is empty.
    std::vector<PixelRect> NewTiles(int block, int rank, const std::vector<int>& before) const;

    Executor executor;
    RankChannel channel;

  private:
    const int tileSize;
    tbb::task_arena* arena;
};

// Run a render as rank 0, which decides, and as another; the arena has no place for the caller.
// There is no display.
RenderResult LeadRanks(const RenderContext&, const RenderOptions&, tbb::task_arena*);
RenderResult FollowRanks(const RenderContext&, const RenderOptions&, tbb::task_arena*);

}  // namespace lull
