// Reads and writes the JSON in which Keras describes a model's layers.
#pragma once

#include <string>
#include <vector>

#include "stopping/network/lstm.h"

namespace lull {

// Describes a layer; the activations mean the same as in LstmLayer and DenseLayer.
struct KerasLayer {
    std::string name;
    bool isLstm = false;  // otherwise Dense
    int units = 0;
    bool useBias = true;
    Activation activation = Activation::Linear;
    Activation recurrentActivation = Activation::Linear;
};

struct KerasModel {
    std::vector<KerasLayer> layers;  // LSTM layers, then Dense ones; without Dropout
    int timeSteps = 0, inputs = 0;   // the shape of the input; 0: not said
};

// Parses `model_config`. `version` is the file's `keras_version`, empty if it has none. Throws
// std::runtime_error naming the layer, the activation or the option that is not supported.
KerasModel ParseKerasConfig(const std::string& json, const std::string& version);

// Returns the `model_config` of a network whose input has `timeSteps` steps.
std::string WriteKerasConfig(const Network& network, int timeSteps);

}  // namespace lull
