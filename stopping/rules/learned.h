// Judges blocks by a network on the history of what an observer sees of them: lull's own rule.
#pragma once

#include <memory>

#include "stopping/network/model_file.h"
#include "stopping/network/window.h"
#include "stopping/rules/criterion.h"

namespace lull {

// Returns the probability that the block of a window (see FeatureHistory) is noisy, in
// [0, 1]; 1 where the network's values overflow, so that nonsense never stops a block.
double NoisyProbability(const Network& network, const Eigen::MatrixXf& window);

// Returns the noise, times the caution, at which a model that looks at nothing else is undecided,
// where noise has fallen with the root of the spp, or not to be told at fixed spacing; 0 for other
// models, and if no noise between 0.001 and 1000 is the limit.
double UndecidedNoise(const Model& model);

// Makes a criterion that votes on the state after a pass once its window is full, and stops after
// as many noiseless votes in a row as the model asks for. Throws std::invalid_argument if the
// network does not fit its settings or has more than one output, or if the spp of the model
// (n, vote_spacing) are no multiples of passSpp, so that no pass would end there. With a passSpp of
// 0 states may come at any spp: where the steps of a window are geometric, the model looks at
// whatever comes n spp or more after its last look and votes; where they are fixed, it looks at
// multiples of n.
std::unique_ptr<Criterion> MakeLearned(std::shared_ptr<const Model> model, int passSpp);

}  // namespace lull
