// The weights of a network in training, and its loss's gradient (back-propagation through time).
#pragma once

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <initializer_list>
#include <numbers>
#include <span>
#include <vector>

#include "stopping/base/hash.h"
#include "stopping/network/lstm.h"

namespace lull {

// Makes random numbers by seed and purpose alone: an interrupted training continues with the same.
class CounterRandom {
  public:
    // Begins the sequence of a seed and a purpose, given as numbers.
    explicit CounterRandom(uint64_t seed, std::initializer_list<uint64_t> purpose = {})
        : key(MixBits(seed)) {
        for (uint64_t p : purpose) key = MixBits(key ^ MixBits(p + 1));
    }

    uint64_t Next() { return MixBits(key + ++count * 0x9e3779b97f4a7c15); }
    // Returns a number in [0, 1), a multiple of 2^-53.
    double Uniform() { return double(Next() >> 11) * 0x1p-53; }
    // Returns an integer in [0, limit), limit > 0.
    uint64_t Below(uint64_t limit) { return uint64_t(Uniform() * double(limit)); }
    double Normal() {
        const double radius = std::sqrt(-2 * std::log(1 - Uniform()));
        return radius * std::cos(2 * std::numbers::pi * Uniform());
    }

  private:
    uint64_t key, count = 0;
};

template <typename Scalar>
using MatrixOf = Eigen::Matrix<Scalar, Eigen::Dynamic, Eigen::Dynamic>;
template <typename Scalar>
using VectorOf = Eigen::Matrix<Scalar, Eigen::Dynamic, 1>;

// An LstmLayer with the paper's activations: sigmoid, and hard sigmoid for the gates.
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

// Returns Keras' initial weights of a network with these inputs, and LSTM layers of these units:
// kernels uniform within sqrt(6 / (inputs + outputs)) (Glorot, Bengio 2010), orthonormal recurrent
// kernels, biases zero except 1 for forget gates. Throws std::invalid_argument if there is no LSTM
// layer, a size is not in [1, 16384], or a layer of more than 2^28 weights.
NetworkWeights<float> InitialWeights(int inputs, std::span<const int> units, uint64_t seed);

template <typename Scalar>
NetworkWeights<Scalar> ZerosLike(const NetworkWeights<Scalar>& weights) {
    NetworkWeights<Scalar> zeros = weights;
    for (std::span<Scalar> span : zeros.Spans()) std::fill(span.begin(), span.end(), Scalar(0));
    return zeros;
}

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
