// Joins recorded blocks with people's thresholds, for networks to learn from and rules to meet.
#pragma once

#include <functional>
#include <span>
#include <string>
#include <vector>

#include "stopping/lab/recordings/recording.h"
#include "stopping/rules/thresholds.h"

namespace lull {

// Returns the result of MeasureBlock() from record i of a block, up to the rounding of recordings.
// Throws std::invalid_argument if features of the settings were not recorded: entropies are
// recorded for m = 4, 25, 100 and 400, H1 and H2 for m = 100 only, and older blocks have no
// attributes.
BlockMeasures MeasuresOf(const BlockRecording& recording, int i, const ModelSettings& settings);

// Names a block that was recorded and that people judged.
struct LabelledBlock {
    std::string viewpoint;
    int block = 0;                              // row-major number
    int human = 0;                              // spp from which on people saw no noise
    int passSpp = 0;                            // of the recording; 0: any spp
    const BlockRecording* recording = nullptr;  // of the data set, which must outlive this
};

// Returns the recorded blocks of all viewpoints that have a row of the same name in `human`, in
// the order of viewpoints and blocks; the names of those without go to `unknown`, which can be
// null. Throws std::invalid_argument for a viewpoint that comes twice, a row without the block or
// blocks with different lengths of passes.
std::vector<LabelledBlock> JoinHuman(std::span<const ViewpointRecording> viewpoints,
                                     std::span<const ThresholdsRow> human,
                                     std::vector<std::string>* unknown);

// Windows, one after the other.
struct TrainingSamples {
    ModelSettings settings;
    int windowSize = 0;               // inputs * k
    std::vector<float> windows = {};  // each column-major as WindowOf() returns it
    std::vector<char> noisy = {};  // of each window, whether its spp is below the human threshold
    std::vector<int> viewpoint = {};  // of each window, counted from 0

    size_t Count() const { return noisy.size(); }
};

// Makes a sample of each window that ends at a multiple of n spp after the first pass and is in
// the recordings as a whole; where records come at any spp, at those at which a model votes
// (LearnedRule()). Throws std::invalid_argument if a block is not recorded every n spp, unless
// records come at any spp and steps are geometric.
TrainingSamples MakeSamples(std::span<const LabelledBlock> blocks, const ModelSettings& settings);

// Reads recordings and thresholds, and splits the blocks.

// Receives warnings for the user, and is called by one thread at a time.
using WarningSink = std::function<void(const std::string& message)>;

// Reads data sets as one; viewpoints can be in several files. Throws std::runtime_error "FILE...".
std::vector<ViewpointRecording> ReadDatasets(const std::vector<std::string>& paths);

// Joins recordings, which must outlive the result, with the thresholds in the file `human`, less
// the viewpoints in `without`; tells which have no thresholds. Throws std::runtime_error if no
// block is left, they do not fit, or for an unknown name in `without`.
std::vector<LabelledBlock> ReadLabelledBlocks(const std::vector<ViewpointRecording>& viewpoints,
                                              const std::string& human,
                                              const std::vector<std::string>& without,
                                              const WarningSink& warn);

// Returns the blocks that were recorded with all that the settings ask for, and tells how many were
// not. Throws std::runtime_error if none is left.
std::vector<LabelledBlock> KeepRecorded(const std::vector<LabelledBlock>& judged,
                                        const ModelSettings& settings, const WarningSink& warn);

// Decides which blocks a network is trained on and which it is judged on.

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
