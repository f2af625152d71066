// Extrapolates recordings beyond their ends by laws fitted to their own numbers, so that rules that
// would have stopped a block later can be judged too.
//
// For n samples per pixel: entropies of sub-blocks are H + a n^-0.9 (falls of entropies are read
// with that exponent where noise has 1, see RateOfFall()); noise, and the errors of rules, fall as
// n^-1/2; deviations from a mean are the root of A + b / n. H, a, A and b are fitted to the last
// two doublings, and laws with a constant go through the last record, so that there is no step;
// other measurements keep their last average.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "stopping/lab/recordings/labelled_blocks.h"

namespace lull {

// Returns the recording with records up to `end` spp, as IsRecorded() spaces them or, where passSpp
// is 0, as far apart as the last two. Where `cycles` has not stopped at a threshold T, it does
// where T^2 times the spp equals that at the least threshold at which it has, if ever. Throws
// std::invalid_argument for a recording without records.
BlockRecording ExtendRecording(const BlockRecording& recording, int passSpp, int end);

// Blocks with recordings extended to kMostShownSpp. It can be moved, but not copied.
struct ExtendedBlocks {
    std::vector<std::unique_ptr<const BlockRecording>> recordings;  // those that were extended
    std::vector<LabelledBlock> blocks;  // all, in their order; those that went on are as they were
};
// Throws as ExtendRecording() does.
ExtendedBlocks ExtendBlocks(std::span<const LabelledBlock> blocks);

}  // namespace lull
