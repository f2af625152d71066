// Decides which blocks a network is trained on and which it is judged on.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "stopping/lab/recordings/training_samples.h"

namespace lull {

// Blocks to train on and others to judge by, which the training never sees.
struct BlockSplit {
    std::string name = {};  // names the part left out
    std::vector<LabelledBlock> training = {}, test = {};
};

// Leaves out the viewpoints of these names. Throws std::invalid_argument for a name without blocks.
BlockSplit LeaveOut(std::span<const LabelledBlock> blocks, std::span<const std::string> names);

// Returns a split for each viewpoint, which leaves it out, or for all viewpoints whose names begin
// with one of `together`: views of one scene. Throws std::invalid_argument if there are fewer than
// two splits, or if no name begins so.
std::vector<BlockSplit> LeaveEachOut(std::span<const LabelledBlock> blocks,
                                     std::span<const std::string> together = {});

// Moves those blocks from the training to the test that are not listed for their viewpoint: a row
// holds the viewpoint's name and the numbers of its blocks to train on (the paper's split has 12 of
// 16). Throws std::invalid_argument if a viewpoint to train on has no row.
void KeepListed(std::span<const ThresholdsRow> rows, BlockSplit* split);

// Returns the blocks that are not listed so: those that a model was not trained on. Throws
// std::invalid_argument for a viewpoint without a row, or if all are listed.
std::vector<LabelledBlock> TestBlocks(std::span<const LabelledBlock> blocks,
                                      std::span<const ThresholdsRow> rows);

}  // namespace lull
