// Reads and writes trained networks in the layout of Keras' model.save(): HDF5 with a JSON
// description (attribute `model_config`) and weights under `model_weights/LAYER`.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "stopping/features/model_inputs.h"
#include "stopping/network/lstm.h"

namespace lull {

struct Model {
    Network network;
    ModelSettings settings;
    std::string checksum;  // of the file it was read from, see FileChecksum()
};

// Reads a Sequential model of LSTM, Dropout and Dense layers, as Keras 2 or tf.keras 2 save it. The
// settings are attributes of the group /lull: integers k, n, m, snorm, votes, vote_spacing,
// reference, the real numbers ratio, mask, flare, nearness, peak_limit, and the strings spacing,
// feature (a list with commas) and pool ("mean"). Absent ones (all, in a published model) have
// their defaults, but k and m follow the shape of the network's input. Throws std::runtime_error
// beginning with the path and naming the parts that are missing or wrong.
Model ReadModel(const std::string& path);

// Writes a model so that ReadModel() returns it and Keras 2 can load it; a new file replaces an old
// one only when complete. `record` says how it was trained; each of its texts (64 KiB at the most)
// becomes an attribute of the group /lull/training. Throws std::invalid_argument as CheckNetwork()
// and CheckSettings(), and std::runtime_error if it cannot be written.
void WriteModel(const std::string& path, const Network& network, const ModelSettings& settings,
                const std::map<std::string, std::string>& record = {});

// Returns the blocks that a model was trained on, by viewpoint, as `record` had them in
// `training_blocks`: a line "VIEWPOINT: BLOCK BLOCK ..." for each. Empty where the file does not
// have them, as published models. Throws std::runtime_error beginning with the path.
std::map<std::string, std::vector<int>> ReadTrainingBlocks(const std::string& path);

// Reads and writes the JSON in which Keras describes a model's layers.

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
