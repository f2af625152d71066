// Computes how the loss of a network changes with its weights (back-propagation through time).
#pragma once

#include <vector>

#include "stopping/lab/training/network_weights.h"

namespace lull {

// Samples that go through the network together. Only float and double are instantiated.
template <typename Scalar>
struct SampleBatch {
    int count = 0, steps = 0;
    // The values of sample s at time step t are in column t * count + s.
    MatrixOf<Scalar> inputs;
    // For each LSTM layer factors of its inputs, a column per sample: 0 where dropped, the same at
    // all time steps (Keras' `dropout`). Empty: nothing is dropped.
    std::vector<MatrixOf<Scalar>> masks = {};
    VectorOf<Scalar> targets;  // desired answers, 0 or 1
    VectorOf<Scalar> weights;  // of the samples in the loss
};

template <typename Scalar>
struct BatchResult {
    double loss = 0;                 // the sum of weight * binary cross-entropy
    VectorOf<Scalar> probabilities;  // the network's answers
};

// Runs the network on a batch and, unless `gradient` is null, adds the gradient of the loss to it.
// `gradient` must have the shape of the weights. The same on any number of threads.
template <typename Scalar>
BatchResult<Scalar> AddGradient(const NetworkWeights<Scalar>& weights,
                                const SampleBatch<Scalar>& batch, NetworkWeights<Scalar>* gradient);

}  // namespace lull
