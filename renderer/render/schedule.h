// Decides which samples are taken next. Pure book-keeping, without threads or pixels: render.cpp
// carries out what is decided here.
#pragma once

#include <optional>
#include <set>
#include <span>
#include <vector>

#include "renderer/output/film.h"

namespace lull {

struct ScheduleOptions {
    int blockSize = 200;  // pixels a side, > 0; blocks at the right and bottom can be smaller
    int passLength = 20;  // samples per pixel and pass, > 0
    int cap = 10000;      // samples per pixel that no block exceeds, > 0
    // Pixels a side of the pieces that threads take, > 0. A sample costs the same at 8 as at 16,
    // but 625 pieces of a block keep 64 threads busy where 169 leave a quarter of them waiting.
    int tileSize = 8;
    int smallestSide = 0;  // blocks with a shorter side follow a neighbour (small_blocks.h)
};

struct Block {
    PixelRect pixels;
    int spp = 0;                 // samples per pixel of all finished passes
    bool votes = true;           // false: too small for its criterion to be asked
    int leader = -1;             // of a block that does not vote: the one it stops with, if any
    bool stopped = false;        // takes no more samples
    bool stoppedByVote = false;  // stopped by its own vote or its leader's, not by the cap
};

// Says where a block is when a schedule begins.
struct BlockStart {
    int spp = 0;  // samples per pixel of all finished passes
    bool stopped = false;
    bool stoppedByVote = false;
};

// Holds a piece of a block's pass: `count` samples from `first` on for each of the pixels.
struct Tile {
    int block;
    PixelRect pixels;
    int first, count;
};

// Cuts a region into blocks, row by row.
std::vector<Block> MakeBlocks(const PixelRect& region, const ScheduleOptions&);

// Knows how far every block is. Blocks are independent of each other: a block's next pass is
// ready as soon as its last one has been decided on. Of the tiles that are ready, those of the
// block with the fewest samples come first, so that an interrupted image is even.
//
// A block too small to vote takes the passes that its leader has finished, and ends at the same
// samples per pixel; so that depends on no order of execution either.
class Schedule {
  public:
    // `starts` is empty, or has as many as there are blocks: to go on where an earlier schedule
    // was, or to leave blocks out.
    Schedule(const PixelRect& region, const ScheduleOptions&,
             std::span<const BlockStart> starts = {});

    std::span<const Block> Blocks() const { return blocks; }
    const ScheduleOptions& Options() const { return options; }

    // Returns how many tiles Next() would give out before the next Decide().
    int ReadyTiles() const { return readyTiles; }
    // Gives out a tile; nothing if none is ready.
    std::optional<Tile> Next();
    // Notes that a tile has been rendered. Returns true if that was the last of its block's pass:
    // the block then has its new spp, and waits for Decide().
    bool Finish(const Tile&);
    // Says whether `block`, whose pass has just been finished, stops here. Ignored for blocks
    // that do not vote. Makes the tiles of the next pass ready (its own and those of followers).
    void Decide(int block, bool stop);

    bool Done() const { return stoppedBlocks == int(blocks.size()); }
    int StoppedBlocks() const { return stoppedBlocks; }
    int MedianSpp() const;
    // Returns the samples left until every live block is at the cap.
    int64_t SamplesToCap() const;

  private:
    struct Progress {
        int target = 0;      // the spp at the end of the pass under way
        int tilesGiven = 0;  // of this pass
        int tilesFinished = 0;
        bool underWay = false;
        std::vector<int> followers;  // of the block
    };

    int TileCount(int block) const;
    void StartPass(int block, int target);
    void GoOn(int block);
    void Stop(int block, bool byVote);
    void CatchUp(int follower);

    ScheduleOptions options;
    std::vector<Block> blocks;
    std::vector<Progress> progress;
    std::set<std::pair<int, int>> ready;  // (spp, block) with tiles to give out
    int readyTiles = 0;
    int stoppedBlocks = 0;
};

}  // namespace lull
