// Moves weights against their gradient, each with a step size of its own.
#pragma once

#include <span>

#include "stopping/lab/training/network_weights.h"

namespace lull {

// Keras' RMSprop (Tieleman, Hinton 2012): with the running mean square a of the gradients g,
// a <- rho a + (1 - rho) g^2, w <- w - rate g / (sqrt(a) + epsilon).
struct RmsProp {
    float rate = 1e-3f, rho = 0.9f, epsilon = 1e-7f;
    NetworkWeights<float> meanSquares = {};  // of the shape of the weights, initially zero

    // Takes a step; the gradient is the sum of `gradients`, each of the shape of the weights.
    void Step(std::span<const NetworkWeights<float>> gradients, NetworkWeights<float>* weights);
};

}  // namespace lull
