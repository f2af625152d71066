// Turns measures of a block into the inputs of a network, in the same way for training, from
// recordings, and for judging, from pixels; and inputs over its passes into windows.
#pragma once

#include <Eigen/Core>

#include <array>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "stopping/base/block_view.h"
#include "stopping/signals/svd_entropy.h"

namespace lull {

// The inputs of a learned rule, and how its answers count.

// Measurements of a block: the entropies of each of m sub-blocks (the paper's features, see
// svd_entropy.h), the visible noise of each of 10 x 10 sub-blocks, from the fall of the entropies H
// since half as many samples (svd_entropy.h; for m = 100), and the differences to filtered
// versions of the whole block (attributes26.h).
enum class Feature { H, H1, H2, VisibleDrop, Attributes26 };

// Convert to and from names: "H", "H1", "H2", "visible_drop" and "attributes26"; a list is
// separated by commas. ParseFeatures() throws std::invalid_argument for others, and for duplicates.
std::string FeatureNames(std::span<const Feature> features);
std::vector<Feature> ParseFeatures(const std::string& names);
inline bool IsEntropy(Feature feature) { return feature <= Feature::H2; }
// Returns whether a feature is a deviation of noise in lightness, which `caution` scales.
inline bool IsNoise(Feature feature) { return feature == Feature::VisibleDrop; }
// Returns whether this feature is normalised over a window, as the paper's are.
inline bool IsNormalized(Feature feature) { return !IsNoise(feature); }
inline bool HasSubBlocks(Feature feature) { return feature != Feature::Attributes26; }

// How far apart the steps of a window are: n spp, or each at `ratio` times the spp of the
// previous one, or the nearest that is kept (History::Thin()).
enum class Spacing { Fixed, Geometric };
std::string SpacingName(Spacing spacing);       // "fixed" or "geometric"
Spacing ParseSpacing(const std::string& name);  // throws std::invalid_argument

// Inputs and votes of a model; the defaults are the paper's.
struct ModelSettings {
    int k = 8;    // steps in a window
    int n = 40;   // spp between them; with geometric spacing between those that are looked at
    int m = 100;  // sub-blocks that entropies are computed of, a square number
    std::vector<Feature> features = {Feature::H};
    bool takesMean = false;  // of the sub-blocks' values, instead of each
    bool snorm = true;       // normalise entropies and attributes over the window, each by itself
    int votes = 3;           // noiseless votes in a row that stop a block
    int voteSpacing = 0;     // spp between votes; 0: vote after every pass
    Spacing spacing = Spacing::Fixed;
    double ratio = 2;                 // of geometric spacing, > 1
    NoiseVisibility visibility = {};  // of visible_drop
    // Peak noise of the block (PeakNoise() in signals/lightness_noise.h), in L*, times
    // NearnessFactor(), from which on a check is no vote to stop; 0: none.
    double peakLimit = 0;
    // Multiplies noise; not part of a model, but of how it is used.
    double caution = 1;

    bool operator==(const ModelSettings&) const = default;
};

bool Needs(const ModelSettings& settings, Feature feature);

// Throws std::invalid_argument naming the setting that is out of range. (There cannot be more
// sub-blocks than the smallest voting block has pixels, so that no block is too small.)
void CheckSettings(const ModelSettings& settings);

// The number of sub-blocks for statistics other than entropies, as in recordings.
inline constexpr int kMeasuredSubBlocks = 100;

// The measures of a block at one spp: for each feature the values of its sub-blocks,
// row-major (m entropies, kMeasuredSubBlocks of other statistics), or the attributes of the block;
// empty if it is not asked for (of entropies, if none is).
struct BlockMeasures {
    int spp = 0;
    std::array<std::vector<double>, size_t(Feature::Attributes26) + 1> values = {};
    SubBlockLightness lightness = {};  // for visible_drop

    std::vector<double>& Of(Feature feature) { return values[size_t(feature)]; }
    const std::vector<double>& Of(Feature feature) const { return values[size_t(feature)]; }
};

// Measures the features of the settings; for drops, which BlockMemory completes, their entropies
// and lightness. Throws as CheckView() and SubBlockEntropies() do.
BlockMeasures MeasureBlock(const BlockView& view, const ModelSettings& settings);

// Which places in the input of a network belong to a feature.
struct InputRange {
    Feature feature;
    int begin = 0, count = 0;
};

// Returns the ranges in the order of the settings' features; they cover all inputs.
std::vector<InputRange> InputRanges(const ModelSettings& settings);
int InputCount(const ModelSettings& settings);

// Returns the input of one step, InputCount() values, before it is normalised over a window:
// entropies and attributes as they are; noise, times the caution, as log(v + 0.1), of its mean if
// that is taken. Throws std::invalid_argument if the measures of a feature have a wrong length.
std::vector<double> InputVector(const BlockMeasures& measures, const ModelSettings& settings);

// Returns whether the mean noise is the only input of a network.
bool LooksAtNoiseOnly(const ModelSettings& settings);

// Convert that noise, >= 0, times the caution, to the network's input, and back.
double InputOfNoise(double noise);
double NoiseOfInput(double input);

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

    // Write and read the state. Restore() throws std::runtime_error if it is damaged.
    void Save(StateWriter* writer) const;
    void Restore(StateReader* reader);

  private:
    bool Complete(BlockMeasures* measures);

    ModelSettings settings;
    History<double> inputs;
    History<float> entropies;  // where their falls are asked for
};

}  // namespace lull
