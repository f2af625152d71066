// A schedule that threads share, with the state of its passes: a clock that can end them, earlier
// values of their pixels, and a viewer that shows where blocks have stopped.
#pragma once

#include <map>
#include <mutex>

#include "renderer/render/render.h"

namespace lull {

// Decision on a block after a pass.
struct BlockAnswer {
    bool stop = false;
    double noise = kUnknownNoise;
};

// Returns the spp at which the round of light paths ends; kNoRoundEnd: there are no rounds.
int LightRoundEnd(const RenderContext&);

// Costs a lock a call, a few for each tile.
class LiveSchedule {
  public:
    // Begins where blocks are, `starts`; empty: from nothing. Context and options
    // must outlive it.
    LiveSchedule(const RenderContext&, const RenderOptions&, std::span<const BlockStart> starts,
                 RankTiles);

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
    // Returns the tiles of a block that a rank has.
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

    const RenderContext& context;
    const RenderOptions& options;
    RankTiles share;
    const bool hasClock;

    std::mutex mutex;  // guards the members below
    Schedule schedule;
    std::map<int, Before> undo;  // for renders that have a clock
    bool timeCalled = false;
    std::vector<char> shownStops;  // blocks that were said to have stopped
};

}  // namespace lull
