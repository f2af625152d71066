// Decides which samples are taken next. Pure book-keeping, without threads or pixels: executor.cpp
// executes the decisions.
#pragma once

#include <limits>
#include <optional>
#include <set>
#include <span>
#include <tuple>
#include <vector>

#include "renderer/film/film.h"

namespace lull {

// The end of a round, in spp, that never comes.
inline constexpr int kNoRoundEnd = std::numeric_limits<int>::max();

struct ScheduleOptions {
    int blockSize = 200;  // pixels a side, > 0; blocks at the right and bottom can be smaller
    int passLength = 20;  // samples per pixel and pass, > 0
    int cap = 10000;      // samples per pixel that no block exceeds, > 0
    // Pixels a side of the pieces that threads take, > 0. A sample costs the same at 8 as at 16,
    // but 625 pieces of a block keep 64 threads busy where 169 leave a quarter of them waiting.
    int tileSize = 8;
    int smallestSide = 0;  // blocks with a shorter side follow a neighbour (thresholds.h)
    // Pixels from where the right eye's image of a pair follows; 0: there is one image. Both are
    // cut alike, and the two blocks of a place take their passes together and stop with the later.
    int eyeWidth = 0;
    // For renders viewed in progress: the first pass is taken in steps of 1, 2, 4, ... spp.
    bool inSteps = false;
    // For renders that have a clock: the next pass is that of the block with the most
    // visible noise, which minimises the largest noise at any moment, after a first pass in
    // steps.
    bool worstFirst = false;
    // Samples per pixel that no block exceeds before the next round has begun.
    int roundEnd = kNoRoundEnd;
};

// Returns the spp at the end of the pass that begins at `spp`, a multiple of the length of passes
// the end of the round, or the cap. With a clock the first pass is done in steps too.
int PassEndAfter(int spp, const ScheduleOptions&);
// Returns whether a pass, or the first as a whole, ends at `spp`.
bool IsPassEnd(int spp, const ScheduleOptions&);

inline TileGrid GridOf(const ScheduleOptions& options) {
    return {options.blockSize, options.tileSize, options.eyeWidth};
}

// Noise not yet estimated; compares above any estimate.
inline constexpr double kUnknownNoise = std::numeric_limits<double>::infinity();

struct Block {
    PixelRect pixels;
    int spp = 0;                   // samples per pixel of all finished passes
    bool votes = true;             // false: too small for its criterion to be asked
    int leader = -1;               // of a block that does not vote: the one it stops with, if any
    int partner = -1;              // the block of the other eye
    bool stopped = false;          // takes no more samples
    bool stoppedByVote = false;    // stopped by its own vote or its leader's, not by the cap
    double noise = kUnknownNoise;  // visible at the end of the last pass, as Decide() was told

    // Returns whether it ended at the cap, with no rule that had stopped it before.
    bool IsAtCap() const { return stopped && !stoppedByVote; }
};

// Which tiles of each block are one's own, where several machines share the work: `deal` names
// the ranks that get one after the other, over and over, beginning at another place in each block.
struct RankTiles {
    int rank = 0;
    std::vector<int> deal = {0};

    bool Has(int block, int tile) const {
        const int place = (tile - block) % int(deal.size());
        return deal[size_t(place < 0 ? place + int(deal.size()) : place)] == rank;
    }
};

// Returns the tiles of block `index` that are in the share, row by row.
std::vector<PixelRect> TilesOf(const PixelRect& block, int index, int tileSize,
                               const RankTiles& = {});

// Where a block is when a schedule begins.
struct BlockStart {
    int spp = 0;  // samples per pixel of all finished passes
    bool stopped = false;
    bool stoppedByVote = false;
    double noise = kUnknownNoise;
    // The spp at the end of a pass that has to be finished though time is called; 0: none.
    int passEnd = 0;
    bool hasVoted = false;  // for its own stop, and waits for the other eye's
};

// A piece of a block's pass: `count` samples from `first` on for each of the pixels.
struct Tile {
    int block;
    PixelRect pixels;
    int first, count;
};

// Returns the images within a region: those of both eyes, the left one first, or one alone.
std::vector<PixelRect> EyesOf(const PixelRect& region, int eyeWidth);

// Cuts a region into blocks, row by row; of a pair, all of the left eye come first.
std::vector<Block> MakeBlocks(const PixelRect& region, const ScheduleOptions&);

// Tracks the passes of all blocks. Blocks are independent of each other: a block's next pass is
// ready as soon as its last one has been decided on. Of the tiles that are ready, those of the
// block with the fewest samples come first, so that an interrupted image is even; or, with
// `worstFirst`, those of a pass that is under way, then those of the noisiest block. A block that
// has less than a sixteenth of that block's samples goes before it, whatever its noise, since an
// estimate from few samples misses rare, bright paths.
//
// A block too small to vote takes the passes that its leader has finished, and ends at the same
// samples per pixel, which are thus independent of the order of execution too.
class Schedule {
  public:
    // `starts` is empty, or has as many as there are blocks: to continue an earlier schedule
    // was, or to leave blocks out.
    // Only tiles of the share are given out and waited for.
    Schedule(const PixelRect& region, const ScheduleOptions&,
             std::span<const BlockStart> starts = {}, const RankTiles& share = {});

    std::span<const Block> Blocks() const { return blocks; }
    const ScheduleOptions& Options() const { return options; }

    // Returns the samples per pixel of all passes of the block that have been decided on.
    int DecidedSpp(int block) const { return progress[block].decidedSpp; }
    // Returns the samples per pixel at the end of the pass under way.
    int PassEnd(int block) const { return progress[block].target; }
    // Returns whether the block's pass has to be finished though time is called.
    bool MustEnd(int block) const { return progress[block].mustEnd; }
    // Returns whether it has voted for its own stop, and may wait for the other eye's.
    bool HasVoted(int block) const { return progress[block].hasVoted; }
    // Returns whether a pass is left that has to be finished though time is called.
    bool MustGoOn() const;

    // Returns how many tiles Next() would give out before the next Decide().
    int ReadyTiles() const { return readyTiles; }
    // Gives out a tile; nothing if none is ready.
    std::optional<Tile> Next();
    // Notes that a tile has been rendered. Returns true if that was the last of its block's pass:
    // the block then has its new spp, and waits for Decide().
    bool Finish(const Tile&);
    // Decides whether `block`, whose pass has just been finished, stops here, which is ignored for
    // blocks that do not vote; `noise` is its visible noise. Makes the tiles of the next pass ready
    // (its own and those of followers).
    void Decide(int block, bool stop, double noise = kUnknownNoise);
    // Gives out no more tiles, but those of passes that have to be finished: the first, or its
    // first step, of each block, so that no part of the image is black, and those begun before this
    // schedule was.
    void CallTime();

    // Returns the fewest samples per pixel of the blocks that have not stopped; 0 if all have.
    int LeastSpp() const;
    // Returns whether all blocks that have not stopped have come to the end of the round; false if
    // all have.
    bool IsRoundOver() const { return !Done() && NoPassUnderWay(); }
    bool NoPassUnderWay() const;
    // Begins a round: makes the passes of these blocks ready.
    void BeginRound(int end);

    bool Done() const { return stoppedBlocks == int(blocks.size()); }
    int StoppedBlocks() const { return stoppedBlocks; }
    int BlocksAtCap() const { return blocksAtCap; }  // of those, not stopped by a vote
    int MedianSpp() const;
    int64_t SamplesToCap() const;

  private:
    struct Progress {
        int decidedSpp = 0;
        int target = 0;                         // the spp at the end of the pass under way
        int tiles = 0;                          // of the share
        int tilesGiven = 0, tilesFinished = 0;  // of this pass
        int next = 0;                           // where to look for the next tile of the share
        bool underWay = false;                  // from its start to the decision
        bool mustEnd = false;                   // though time has been called
        bool hasVoted = false;                  // once, for its stop
        std::vector<int> followers;             // of the block
    };

    int NextBlock() const;
    PixelRect TakeTile(int block);
    std::tuple<double, int, int> ByNoise(int block) const;
    void StartPass(int block, int target);
    void MakeReady(int block);
    void MakeUnready(int block);
    void GoOn(int block, int target);
    void Stop(int block, bool byVote);
    bool IsAhead(int block) const;
    void DecidePair(int block);
    void CatchUp(int follower);

    ScheduleOptions options;
    RankTiles share;
    std::vector<Block> blocks;
    std::vector<Progress> progress;
    std::set<std::pair<int, int>> ready;                  // (spp, block) with tiles to give out
    std::set<std::tuple<double, int, int>> readyByNoise;  // the same, where the worst is first
    int current = -1;  // the block whose pass is being given out, where the worst is first
    bool timeCalled = false;
    int readyTiles = 0;
    int stoppedBlocks = 0, blocksAtCap = 0;
};

}  // namespace lull
