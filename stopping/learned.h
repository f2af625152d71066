// Judges blocks by a recurrent network on the history of their SVD-entropies: lull's own rule.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "stopping/criterion.h"
#include "stopping/model_file.h"
#include "stopping/window.h"

namespace lull {

// Computes the feature of a block as an observer sees it: of the lightness of its 8-bit sRGB, one
// entropy in [0, 1] for each of m sub-blocks, row-major. `mean` is the linear radiance of
// width * height pixels as in BlockView. Throws as SubBlockEntropies() does.
std::vector<double> ComputeFeature(std::span<const float> mean, int width, int height, int m,
                                   Feature feature);

// Returns the probability that the block of a window (m x k, see FeatureHistory) is noisy, in
// [0, 1]; 1 where the network's values overflow, so that nonsense never stops a block.
double NoisyProbability(const Network& network, const Eigen::MatrixXf& window);

// Makes a criterion that votes on the state after a pass once its window is full, and stops after
// as many noiseless votes in a row as the model asks for. Throws std::invalid_argument if the
// network does not fit its settings or has more than one output, or if the spp of the model
// (n, vote_spacing) are no multiples of passSpp, so that no pass would end there.
std::unique_ptr<Criterion> MakeLearned(std::shared_ptr<const Model> model, int passSpp);

}  // namespace lull
