// Collects the features of a block over its passes into the sequence that a network reads.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "stopping/svd_entropy.h"

namespace lull {

enum class Feature { H, H1, H2 };

// Converts to and from the names "H", "H1" and "H2". ParseFeature() throws std::invalid_argument
// for others.
std::string FeatureName(Feature feature);
Feature ParseFeature(const std::string& name);

// Says what a model was trained on and how its answers count; the defaults are the paper's.
struct ModelSettings {
    int k = 8;    // features in a window
    int n = 40;   // spp between them
    int m = 100;  // sub-blocks, a square number: the length of a feature
    Feature feature = Feature::H;
    bool snorm = true;    // normalise each component over the window
    bool bnorm = false;   // normalise each feature over its components, before that
    int votes = 3;        // noiseless votes in a row that stop a block
    int voteSpacing = 0;  // spp between votes; 0: vote after every pass
};

// Throws std::invalid_argument naming the setting that is out of range. (More sub-blocks than the
// smallest block that votes has pixels are too many, so that no block turns out to be too small.)
void CheckSettings(const ModelSettings& settings);

// Returns (v - min) / (max - min + 2.2e-16) for each value: in [0, 1], and all 0 if they are
// equal. At least one value; they and their spread must be finite.
Eigen::ArrayXd Normalize(const Eigen::ArrayXd& values);

// Keeps the features that windows still to come can need.
class FeatureHistory {
  public:
    // Throws std::invalid_argument if the settings are out of range.
    explicit FeatureHistory(const ModelSettings& settings);

    // Adds a feature of m finite values. Spp must increase; throws std::invalid_argument.
    void Add(int spp, std::span<const double> feature);

    // Returns the window that ends at `spp`, m x k, the oldest feature first, normalised as the
    // settings say; nothing unless there are features at spp, spp - n, ..., spp - (k - 1) n.
    std::optional<Eigen::MatrixXf> WindowAt(int spp) const;

    struct Entry {
        int spp = 0;
        std::vector<double> feature;
    };
    const std::vector<Entry>& Entries() const { return entries; }  // the oldest first
    void Clear() { entries.clear(); }

  private:
    const std::vector<double>* Find(int spp) const;

    ModelSettings settings;
    std::vector<Entry> entries;
};

}  // namespace lull
