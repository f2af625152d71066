// Keeps the measurements of a block for later windows.
#pragma once

#include <Eigen/Core>

#include <optional>
#include <vector>

#include "stopping/features/model_inputs.h"
#include "stopping/signals/history.h"

namespace lull {

// Collects the features of a block over its passes into the sequence that a network reads.

// Returns (v - min) / (max - min + 2.2e-16) for each value: in [0, 1], and all 0 if they are
// equal. At least one value; they and their spread must be finite.
Eigen::ArrayXd Normalize(const Eigen::ArrayXd& values);

// Adds an InputVector() and discards steps that no later window can need. Throws
// std::invalid_argument if it does not have InputCount() values, and as History::Add() does.
void AddInputs(int spp, std::vector<double> inputs, const ModelSettings& settings,
               History<double>* history);

// Returns the window that ends at `spp`, InputCount() x k, the oldest step first, its entropies and
// attributes normalised as the settings say (for other features the level matters); nothing unless
// there are inputs for spp, spp - n, ..., spp - (k - 1) n. With geometric spacing the steps are the
// stored ones nearest to spp / ratio, spp / ratio^2, ..., eight an octave: for k steps 2 + 8 (k -
// 1) log2(ratio) inputs at most; `spp` is the last one added.
std::optional<Eigen::MatrixXf> WindowOf(const History<double>& history,
                                        const ModelSettings& settings, int spp);

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
