#include "stopping/network/lstm.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <vector>

#include "tests/stopping/network/random_network.h"

namespace lull {
namespace {

double Apply(Activation activation, double x) {
    switch (activation) {
        case Activation::Sigmoid:
            return 1 / (1 + std::exp(-x));
        case Activation::HardSigmoid:
            return std::clamp(0.2 * x + 0.5, 0.0, 1.0);
        case Activation::Tanh:
            return std::tanh(x);
        default:
            return x;
    }
}

// Runs the network as its equations are written, one number at a time and in double.
double RunPlainly(const Network& network, const Eigen::MatrixXf& sequence) {
    Eigen::MatrixXd input = sequence.cast<double>();
    for (const LstmLayer& l : network.lstm) {
        const Eigen::Index u = l.Units();
        Eigen::MatrixXd output(u, input.cols());
        std::vector<double> hidden(size_t(u), 0.0), cell(size_t(u), 0.0);
        for (Eigen::Index t = 0; t < input.cols(); ++t) {
            const std::vector<double> before = hidden;
            for (Eigen::Index j = 0; j < u; ++j) {
                double gate[4];
                for (int g = 0; g < 4; ++g) {
                    double z = double(l.bias[g * u + j]);
                    for (Eigen::Index i = 0; i < input.rows(); ++i)
                        z += double(l.kernel(g * u + j, i)) * input(i, t);
                    for (Eigen::Index i = 0; i < u; ++i)
                        z += double(l.recurrent(g * u + j, i)) * before[size_t(i)];
                    gate[g] = Apply(g == 2 ? l.activation : l.recurrentActivation, z);
                }
                double& c = cell[size_t(j)];
                c = gate[1] * c + gate[0] * gate[2];
                hidden[size_t(j)] = gate[3] * Apply(l.activation, c);
                output(j, t) = hidden[size_t(j)];
            }
        }
        input = output;
    }
    const Eigen::VectorXd last = input.rightCols(1);
    const DenseLayer& dense = network.dense.front();
    double z = double(dense.bias[0]);
    for (Eigen::Index i = 0; i < last.size(); ++i) z += double(dense.kernel(0, i)) * last[i];
    return Apply(dense.activation, z);
}

TEST(Lstm, FollowsTheEquations) {
    for (Activation activation : {Activation::Sigmoid, Activation::Tanh, Activation::Linear})
        for (Activation gates : {Activation::HardSigmoid, Activation::Sigmoid}) {
            Network network = RandomNetwork(9, {12, 7, 3}, 0.8f);
            for (LstmLayer& l : network.lstm) {
                l.activation = activation;
                l.recurrentActivation = gates;
            }
            CheckNetwork(network);
            for (Eigen::Index steps : {1, 2, 8}) {
                const Eigen::MatrixXf sequence = Eigen::MatrixXf::Random(9, steps);
                EXPECT_NEAR(RunNetwork(network, sequence)[0], RunPlainly(network, sequence), 1e-5);
            }
        }
}

TEST(Lstm, StaysFiniteWithHugeWeights) {
    for (float range : {1e4f, 1e30f}) {
        const Network network = RandomNetwork(25, {32, 8}, range, 5);
        const Eigen::VectorXf p = RunNetwork(network, Eigen::MatrixXf::Constant(25, 8, 1));
        EXPECT_GE(p[0], 0);
        EXPECT_LE(p[0], 1);
    }
}

TEST(Lstm, RefusesNetworksThatDoNotFit) {
    const Network good = RandomNetwork(4, {3, 2}, 1);
    EXPECT_NO_THROW(CheckNetwork(good));
    EXPECT_THROW(CheckNetwork({}), std::invalid_argument);
    EXPECT_THROW(CheckNetwork({.lstm = {}, .dense = good.dense}), std::invalid_argument);

    Network bad = good;
    bad.lstm[1].kernel.resize(8, 4);
    bad.lstm[1].kernel.setZero();
    EXPECT_THROW(CheckNetwork(bad), std::invalid_argument);
    bad = good;
    bad.dense[0].bias.setZero(2);
    EXPECT_THROW(CheckNetwork(bad), std::invalid_argument);
    bad = good;
    bad.lstm[0].recurrent(3, 1) = std::numeric_limits<float>::quiet_NaN();
    EXPECT_THROW(CheckNetwork(bad), std::invalid_argument);
    bad = good;
    bad.dense[0].kernel(0, 1) = std::numeric_limits<float>::infinity();
    EXPECT_THROW(CheckNetwork(bad), std::invalid_argument);

    EXPECT_THROW(RunNetwork(good, Eigen::MatrixXf::Zero(5, 8)), std::invalid_argument);
    EXPECT_THROW(RunNetwork(good, Eigen::MatrixXf(4, 0)), std::invalid_argument);
}

}  // namespace
}  // namespace lull
