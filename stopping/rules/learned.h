// Stops blocks by a network on the history of their visible noise: lull's own rule.
#pragma once

#include <memory>
#include <span>
#include <string>

#include "stopping/features/model_inputs.h"
#include "stopping/network/model_file.h"
#include "stopping/rules/rule.h"
#include "stopping/signals/svd_entropy.h"

namespace lull {

// Returns the probability that the block of a window (WindowOf()) is noisy, in
// [0, 1]; 1 where the network's values overflow, so that nonsense never stops a block.
double NoisyProbability(const Network& network, const Eigen::MatrixXf& window);

// Makes a rule that votes on the state after a pass once its window is full, and stops after as
// many noiseless votes in a row as the model asks for. Throws std::invalid_argument if the network
// does not fit its settings or has more than one output, or if the spp of the model (n,
// vote_spacing) are no multiples of passSpp. With a passSpp of 0 states may come at any spp: by
// geometric steps the model checks whatever comes n spp or more after its last check, by fixed ones
// multiples of n.
Rule LearnedRule(std::shared_ptr<const Model> model, int passSpp);

// The model where none is named.
inline constexpr const char* kDefaultModelName = "entropy";

Rule ReadLearned(const std::string& argument, const RuleContext& context);

// Returns the file of the model that `learned:ARGUMENT` names: one that ends in .h5 or is there, or
// NAME.h5 in the folder of installed models. Throws std::runtime_error naming those that there are.
std::string ModelPath(const std::string& argument, const std::string& models);

// Reads a model as it is used in a context, with its cap and caution. Throws std::runtime_error.
Model ReadModelFor(const std::string& path, const RuleContext& context);

// Stops blocks by the noise in their SVD-entropy: lull's own rule with one number.

// The sub-blocks that the rule looks at.
inline constexpr int kEntropySubBlocks = 100;

// Stops a block when the mean visible drop of its sub-blocks (see svd_entropy.h) was below
// `threshold`, > 0, at three checks in a row. The block needs at least 20 x 20 pixels.
Rule EntropyRule(double threshold, const NoiseVisibility& visibility, int passSpp);

// Reads the threshold T, which the context's caution divides.
Rule ReadEntropy(const std::string& argument, const RuleContext& context);

// Returns its checks: after the first pass and every 40 spp from then on, or every pass if passes
// are longer, as in recordings (see recording.h); with a passSpp of 0, at the first picture 40 spp
// or more after the last check.
Checks EntropyChecks(int passSpp);

// Returns the number that is compared with the threshold.
double MeanVisible(std::span<const double> visibleDrops);

}  // namespace lull
