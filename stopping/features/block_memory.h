// Keeps the measurements of a block for later windows.
#pragma once

#include <optional>

#include "stopping/features/window.h"

namespace lull {

// Turns the measures of a block, check by check, into windows: adds how far entropies have fallen
// since half as many samples, and keeps the inputs.
class BlockMemory {
  public:
    // Throws std::invalid_argument if the settings are out of range.
    explicit BlockMemory(const ModelSettings& settings);

    // Adds measures, with increasing spp; those without an earlier state to compare with give no
    // inputs. Throws as InputVector() and History::Add() do.
    void Add(BlockMeasures measures);

    // Returns the window that ends at `spp`, as WindowOf() does.
    std::optional<Eigen::MatrixXf> WindowAt(int spp) const {
        return WindowOf(inputs, settings, spp);
    }

    // Write and read all that Add() has left behind. Restore() throws std::runtime_error if it is
    // damaged.
    void Save(StateWriter* writer) const;
    void Restore(StateReader* reader);

  private:
    bool Complete(BlockMeasures* measures);

    ModelSettings settings;
    History<double> inputs;
    History<float> entropies;  // where their falls are asked for
};

}  // namespace lull
