// Makes training samples for networks: windows of recordings, and whether observers saw noise.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "stopping/lab/recordings/dataset.h"
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
    int cap = 0, passSpp = 0;                   // of the recording; pass 0: any spp
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

}  // namespace lull
