// The weights of a network that is being trained.
#pragma once

#include <Eigen/Core>

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

#include "stopping/network/lstm.h"

namespace lull {

template <typename Scalar>
using MatrixOf = Eigen::Matrix<Scalar, Eigen::Dynamic, Eigen::Dynamic>;
template <typename Scalar>
using VectorOf = Eigen::Matrix<Scalar, Eigen::Dynamic, 1>;

// The same as LstmLayer, with the paper's activations: sigmoid, and hard sigmoid for the
// gates.
template <typename Scalar>
struct LstmWeights {
    MatrixOf<Scalar> kernel, recurrent;
    VectorOf<Scalar> bias;
};

// The same as DenseLayer, with the sigmoid.
template <typename Scalar>
struct DenseWeights {
    MatrixOf<Scalar> kernel;
    VectorOf<Scalar> bias;
};

// The weights of a network, or a gradient with respect to them.
template <typename Scalar>
struct NetworkWeights {
    std::vector<LstmWeights<Scalar>> lstm;
    std::vector<DenseWeights<Scalar>> dense;

    // Returns all arrays, each as one span, in the order of the layers.
    std::vector<std::span<Scalar>> Spans() { return Collect<Scalar>(*this); }
    std::vector<std::span<const Scalar>> Spans() const { return Collect<const Scalar>(*this); }

  private:
    template <typename Element, typename Self>
    static std::vector<std::span<Element>> Collect(Self& self) {
        std::vector<std::span<Element>> spans;
        auto add = [&](auto& array) { spans.emplace_back(array.data(), size_t(array.size())); };
        for (auto& l : self.lstm) add(l.kernel), add(l.recurrent), add(l.bias);
        for (auto& l : self.dense) add(l.kernel), add(l.bias);
        return spans;
    }
};

// How large a network is.
struct NetworkShape {
    int inputs = 0, steps = 0;               // of its sequences
    std::vector<int> lstm = {512, 128, 32};  // units; the paper's
};

// Returns Keras' initial weights: kernels uniform within sqrt(6 / (inputs + outputs)) (Glorot,
// Bengio 2010), orthonormal recurrent kernels, biases zero except 1 for forget gates. Throws
// std::invalid_argument if there is no LSTM layer, a size is not in [1, 16384], or a layer of more
// than 2^28 weights.
NetworkWeights<float> InitialWeights(const NetworkShape& shape, uint64_t seed);

// Returns weights of the same shape, all zero.
template <typename Scalar>
NetworkWeights<Scalar> ZerosLike(const NetworkWeights<Scalar>& weights) {
    NetworkWeights<Scalar> zeros = weights;
    for (std::span<Scalar> span : zeros.Spans()) std::fill(span.begin(), span.end(), Scalar(0));
    return zeros;
}

// Returns the network that has these weights.
Network MakeNetwork(const NetworkWeights<float>& weights);

// Moves weights against their gradient, each with a step size of its own.

// Keras' RMSprop (Tieleman, Hinton 2012): with the running mean square a of the gradients g,
// a <- rho a + (1 - rho) g^2, w <- w - rate g / (sqrt(a) + epsilon).
struct RmsProp {
    float rate = 1e-3f, rho = 0.9f, epsilon = 1e-7f;
    NetworkWeights<float> meanSquares = {};  // of the shape of the weights, initially zero

    // Takes a step; the gradient is the sum of `gradients`, each of the shape of the weights.
    void Step(std::span<const NetworkWeights<float>> gradients, NetworkWeights<float>* weights);
};

}  // namespace lull
