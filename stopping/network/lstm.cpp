#include "stopping/network/lstm.h"

#include <stdexcept>

namespace lull {

namespace {

template <typename Vector>
void Activate(Activation activation, Vector&& x) {
    switch (activation) {
        case Activation::Linear:
            break;
        case Activation::Sigmoid:
            x = (1 + (-x.array()).exp()).inverse().matrix();
            break;
        case Activation::HardSigmoid:
            x = (0.2f * x.array() + 0.5f).cwiseMax(0.f).cwiseMin(1.f).matrix();
            break;
        case Activation::Tanh:
            x = x.array().tanh().matrix();
            break;
    }
}

// Returns the hidden state after each time step, one a column.
//
// Each step reads all recurrent weights once, so that its time is that of streaming them from the
// cache; the products with the inputs do not depend on each other and are done in one go. Of the
// window before nothing can be used again: all states follow from its first step.
Eigen::MatrixXf RunLstm(const LstmLayer& layer, const Eigen::MatrixXf& sequence) {
    const Eigen::Index u = layer.Units(), steps = sequence.cols();
    Eigen::MatrixXf gates = layer.kernel * sequence;
    gates.colwise() += layer.bias;
    Eigen::MatrixXf hidden(u, steps);
    Eigen::VectorXf cell = Eigen::VectorXf::Zero(u);
    for (Eigen::Index t = 0; t < steps; ++t) {
        auto z = gates.col(t);
        if (t > 0) z.noalias() += layer.recurrent * hidden.col(t - 1);
        auto i = z.segment(0, u), f = z.segment(u, u), c = z.segment(2 * u, u),
             o = z.segment(3 * u, u);
        Activate(layer.recurrentActivation, z.head(2 * u));
        Activate(layer.activation, c);
        Activate(layer.recurrentActivation, o);
        cell = f.cwiseProduct(cell) + i.cwiseProduct(c);
        auto h = hidden.col(t);
        h = cell;
        Activate(layer.activation, h);
        h = h.cwiseProduct(o);
    }
    return hidden;
}

void Check(bool isRight, const std::string& layer, const char* message) {
    if (!isRight) throw std::invalid_argument("layer '" + layer + "': " + message);
}

}  // namespace

void CheckNetwork(const Network& network) {
    if (network.lstm.empty())
        throw std::invalid_argument("a network needs at least one LSTM layer");
    Eigen::Index inputs = network.lstm.front().Inputs();
    for (const LstmLayer& l : network.lstm) {
        const Eigen::Index u = l.Units();
        Check(u > 0 && l.Inputs() > 0, l.name, "has no units or no inputs");
        Check(l.Inputs() == inputs, l.name, "takes another number of values than it is given");
        Check(l.kernel.rows() == 4 * u && l.recurrent.rows() == 4 * u && l.bias.size() == 4 * u,
              l.name, "its kernel, recurrent kernel and bias differ in units");
        Check(l.kernel.allFinite() && l.recurrent.allFinite() && l.bias.allFinite(), l.name,
              "a weight is NaN or infinite");
        inputs = u;
    }
    for (const DenseLayer& l : network.dense) {
        Check(l.kernel.rows() > 0 && l.kernel.cols() > 0, l.name, "has no units or no inputs");
        Check(l.kernel.cols() == inputs, l.name, "takes another number of values than it is given");
        Check(l.bias.size() == l.kernel.rows(), l.name, "its kernel and bias differ in units");
        Check(l.kernel.allFinite() && l.bias.allFinite(), l.name, "a weight is NaN or infinite");
        inputs = l.kernel.rows();
    }
}

Eigen::VectorXf RunNetwork(const Network& network, const Eigen::MatrixXf& sequence) {
    if (sequence.cols() == 0 || sequence.rows() != network.lstm.front().Inputs())
        throw std::invalid_argument("the sequence does not have the size of the network's input");
    Eigen::MatrixXf states = sequence;
    for (const LstmLayer& layer : network.lstm) states = RunLstm(layer, states);
    Eigen::VectorXf x = states.rightCols(1);
    for (const DenseLayer& layer : network.dense) {
        x = (layer.kernel * x + layer.bias).eval();
        Activate(layer.activation, x);
    }
    return x;
}

}  // namespace lull
