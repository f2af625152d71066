// Makes networks with random weights.
#pragma once

#include <random>
#include <vector>

#include "stopping/network/lstm.h"

namespace lull {

// Returns LSTM layers of the given units and a dense one of one unit, with weights uniform in
// [-range, range].
inline Network RandomNetwork(int inputs, const std::vector<int>& units, float range,
                             unsigned seed = 1) {
    std::mt19937 generator(seed);
    std::uniform_real_distribution<float> uniform(-range, range);
    auto matrix = [&](Eigen::Index rows, Eigen::Index columns) {
        return Eigen::MatrixXf(
            Eigen::MatrixXf::NullaryExpr(rows, columns, [&] { return uniform(generator); }));
    };
    Network network;
    for (int u : units) {
        const std::string name = "lstm_" + std::to_string(network.lstm.size() + 1);
        network.lstm.push_back({name, matrix(4 * u, inputs), matrix(4 * u, u), matrix(4 * u, 1)});
        inputs = u;
    }
    network.dense.push_back({"dense_1", matrix(1, inputs), matrix(1, 1)});
    return network;
}

}  // namespace lull
