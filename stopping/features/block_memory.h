// Remembers what the later windows of a block are made of.
#pragma once

#include <array>
#include <optional>

#include "stopping/features/window.h"
#include "stopping/signals/drop_history.h"

namespace lull {

// Turns the measures of a block, pass by pass, into windows: adds how far entropies have fallen
// since half as many samples, and keeps the inputs.
class BlockMemory {
  public:
    // Throws std::invalid_argument if the settings are out of range.
    explicit BlockMemory(const ModelSettings& settings);

    // Adds measures, with increasing spp; those without an earlier state to compare with give no
    // inputs. Throws as InputVector() and FeatureHistory::Add() do.
    void Add(BlockMeasures measures);

    // Returns the window that ends at `spp`, as FeatureHistory::WindowAt() does.
    std::optional<Eigen::MatrixXf> WindowAt(int spp) const { return inputs.WindowAt(spp); }

    // Write and read all that Add() has left behind. Restore() throws std::runtime_error if it is
    // damaged.
    void Save(StateWriter* writer) const;
    void Restore(StateReader* reader);

  private:
    static constexpr std::array kDrops = {Feature::EntropyDrop, Feature::EntropyDrop1,
                                          Feature::EntropyDrop2, Feature::VisibleDrop};

    bool Complete(BlockMeasures* measures);

    ModelSettings settings;
    FeatureHistory inputs;
    std::array<DropHistory, kDrops.size()> drops;  // those of features that are asked for
};

}  // namespace lull
