// One of several ranks of a render (peers.h).
#pragma once

#include "renderer/render/executor_internal.h"
#include "renderer/render/ranks/channel.h"

namespace lull {

// Has an executor, whose tasks are done by the threads of the arena, and a channel, by which the
// calling thread speaks with the other ranks.
class Rank {
  public:
    Rank(const RenderContext&, const RenderOptions&, tbb::task_arena*, RankHooks);

    // Runs `body`; after an exception no task is at work.
    template <typename Body>
    RenderResult Guarded(const Body& body) try {
        return body();
    } catch (...) {
        executor.Quiesce();
        throw;
    }

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
