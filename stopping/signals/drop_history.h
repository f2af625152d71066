// Compares each state of a block with the one at half as many samples.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "stopping/base/state.h"
#include "stopping/signals/entropy_drop.h"

namespace lull {

// Keeps the entropies that later states are compared with: about eight an octave down to a quarter
// of the spp, at most 19 states (8 KB per block for 100 sub-blocks), however many samples there
// are.
class DropHistory {
  public:
    // Adds the entropies of the sub-blocks at `spp`, which increases; they are finite and always
    // the same number. Returns EntropyDrop() since the state nearest to half of the spp, corrected
    // by RateOfFall() with these weights if there is also one at about a quarter; nothing before
    // there is such a state. Throws std::invalid_argument.
    std::optional<std::vector<double>> Add(int spp, std::span<const double> entropies,
                                           std::span<const double> weights);

    // Write and read all states. Restore() throws std::runtime_error if they are damaged or do not
    // have `subBlocks` values each.
    void Save(StateWriter* writer) const;
    void Restore(StateReader* reader, size_t subBlocks);

    const std::vector<EntropyState>& States() const { return states; }

  private:
    std::vector<EntropyState> states;  // a ladder, see ladder.h
};

// Adds a state, entropies and lightness of its sub-blocks, to the history of a block. Returns
// VisibleDrop() as DropHistory::Add() does; for the rate of the fall, sub-blocks are weighted as
// their noise is in lightness.
std::optional<std::vector<double>> AddVisible(int spp, std::span<const double> entropies,
                                              const SubBlockLightness& lightness,
                                              const NoiseVisibility& visibility,
                                              DropHistory* history);

}  // namespace lull
