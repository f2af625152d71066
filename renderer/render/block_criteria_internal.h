// Asks the criteria of blocks after each pass.
#pragma once

#include <tbb/enumerable_thread_specific.h>

#include "renderer/render/live_schedule_internal.h"

namespace lull {

// The decision on a block after a pass.
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
    // Makes the criteria of the blocks that vote, as an interrupted render has left them. The
    // context must outlive it.
    BlockCriteria(const RenderContext&, const RenderOptions&, std::span<const Block> blocks);

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

    const RenderContext& context;
    const ScheduleOptions schedule;
    const bool hasClock;
    std::vector<std::unique_ptr<Criterion>> criteria;  // null for blocks that do not vote
    tbb::enumerable_thread_specific<FilmView> views;
};

// Returns the most samples that a pixel has.
int MostSamples(const PixelRect&, const Film&);

// Return where blocks are, those given or those that an interrupted render has left, none if there
// is none; with a clock, also how noisy.
std::vector<BlockStart> StartsOf(std::span<const BlockResult> blocks, const RenderContext&,
                                 const RenderOptions&);
std::vector<BlockStart> StartsOf(const RenderContext&, const RenderOptions&);

}  // namespace lull
