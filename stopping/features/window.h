// Collects the features of a block over its passes into the sequence that a network reads.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>
#include <vector>

#include "stopping/features/model_inputs.h"

namespace lull {

// Returns (v - min) / (max - min + 2.2e-16) for each value: in [0, 1], and all 0 if they are
// equal. At least one value; they and their spread must be finite.
Eigen::ArrayXd Normalize(const Eigen::ArrayXd& values);

// Keeps the inputs that later windows can need.
class FeatureHistory {
  public:
    // Throws std::invalid_argument if the settings are out of range.
    explicit FeatureHistory(const ModelSettings& settings);

    // Adds an InputVector(), whose values must be finite. Spp must increase; throws
    // std::invalid_argument.
    void Add(int spp, std::span<const double> feature);

    // Returns the window that ends at `spp`, InputCount() x k, the oldest step first, its entropies
    // and attributes normalised as the settings say (for other features the level matters); nothing
    // unless there are inputs for spp, spp - n, ..., spp - (k - 1) n. With geometric spacing the
    // steps are those that are nearest to spp / ratio, spp / ratio^2, ... of what is kept, eight an
    // octave (see ladder.h): for k steps 2 + 8 (k - 1) log2(ratio) inputs at most; `spp` is the
    // last one added.
    std::optional<Eigen::MatrixXf> WindowAt(int spp) const;

    struct Entry {
        int spp = 0;
        std::vector<double> feature;
    };
    const std::vector<Entry>& Entries() const { return entries; }  // the oldest first
    void Clear() { entries.clear(); }

  private:
    const std::vector<double>* FindStep(int spp, int stepsBefore) const;
    const std::vector<double>* Find(int spp) const;
    void NormalizeRange(Eigen::Ref<Eigen::ArrayXXd> window) const;

    ModelSettings settings;
    std::vector<InputRange> ranges;
    int inputs;
    std::vector<Entry> entries;
};

}  // namespace lull
