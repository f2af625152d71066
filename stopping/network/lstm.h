// Runs a small network: LSTM layers, then dense layers, with the semantics of Keras 2.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

namespace lull {

// HardSigmoid is Keras 2's: clip(0.2 x + 0.5, 0, 1).
enum class Activation { Linear, Sigmoid, HardSigmoid, Tanh };

// One long short-term memory layer (Hochreiter, Schmidhuber 1997). The weights are Keras'
// arrays transposed, with the gates one below the other in Keras' order: input i, forget f, cell
// candidate c, output o; u units each.
struct LstmLayer {
    std::string name;
    Eigen::MatrixXf kernel;                                    // 4u x inputs
    Eigen::MatrixXf recurrent;                                 // 4u x u
    Eigen::VectorXf bias;                                      // 4u
    Activation activation = Activation::Sigmoid;               // of candidate and output
    Activation recurrentActivation = Activation::HardSigmoid;  // of the gates

    Eigen::Index Units() const { return recurrent.cols(); }
    Eigen::Index Inputs() const { return kernel.cols(); }
    bool operator==(const LstmLayer&) const = default;
};

struct DenseLayer {
    std::string name;
    Eigen::MatrixXf kernel;  // outputs x inputs
    Eigen::VectorXf bias;    // outputs
    Activation activation = Activation::Sigmoid;

    bool operator==(const DenseLayer&) const = default;
};

// LSTM layers, each of which hands its output at every time step to the next one, followed by
// dense layers on the output of the last time step.
struct Network {
    std::vector<LstmLayer> lstm;
    std::vector<DenseLayer> dense;  // may be none

    bool operator==(const Network&) const = default;
};

// Checks that there is an LSTM layer, that the shapes fit together and that all weights are finite.
// Throws std::invalid_argument naming the layer.
void CheckNetwork(const Network& network);

// Runs the network, which has passed CheckNetwork(), on a sequence: one column per time step, at
// least one. Throws std::invalid_argument if the network does not take sequences of this size.
// Finite inputs give finite outputs, unless linear activations let the values overflow.
Eigen::VectorXf RunNetwork(const Network& network, const Eigen::MatrixXf& sequence);

}  // namespace lull
