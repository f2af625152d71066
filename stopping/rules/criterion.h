// Defines the one interface between renderer and stopping rules: after each pass a block is shown
// to its criterion, which answers continue or stop.
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "stopping/base/block_view.h"

namespace lull {

// Answer of a criterion. No number in it is ever NaN.
struct Decision {
    bool stop = false;
    // Whether the block was checked in this call; if not, the numbers are the last check's.
    bool checked = false;
    double value = 0;      // an error estimate, P(noisy) or the spp
    double threshold = 0;  // of the value
    int votes = 0;         // checks in a row that were below it (rules that vote only)
};

// Decides on one block over all its passes, with the state of its earlier checks. Different
// criteria can be used by different threads at the same time.
class Criterion {
  public:
    virtual ~Criterion() = default;

    // Returns the spans that Observe() will read at `spp`, so that no view is built in vain.
    virtual ViewNeed Need(int spp) const = 0;

    // Adds the block after a pass and decides. To be called once after every pass, with increasing
    // spp, whatever Need() returns, and no more once it has answered stop. Throws
    // std::invalid_argument if the spans that Need() asks for do not have the block's size, or if
    // spp or the size contradict earlier calls.
    virtual Decision Observe(const BlockView& view) = 0;

    // Returns the noise given to a network at the last check, if it has no other input: forecasts
    // follow it in place of the probability (trend.h).
    virtual std::optional<double> NetworkNoise() const { return {}; }

    // Return and set the state that Observe() keeps between calls, for checkpoints. Restore()
    // throws std::runtime_error if `state` was saved by another rule or is damaged; the criterion
    // must not be used afterwards.
    virtual std::vector<std::byte> Save() const { return {}; }
    virtual void Restore(std::span<const std::byte> state);
};

// Position of the block of a criterion.
struct BlockInfo {
    int index = 0;            // row-major place in the grid of blocks
    double areaFraction = 1;  // pixels of the block / pixels of the image, in (0, 1]
};

// Makes a block's own criterion, in any thread.
using CriterionMaker = std::function<std::unique_ptr<Criterion>(const BlockInfo&)>;

}  // namespace lull
