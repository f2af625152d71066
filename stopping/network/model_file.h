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
// beginning with the path and naming the parts that are missing, not supported, of the wrong shape,
// NaN or infinite.
Model ReadModel(const std::string& path);

// Writes a model so that ReadModel() returns it and Keras 2 can load it; a new file replaces an old
// one only when complete. `record` says how it was trained; each of its texts (64 KiB at the most)
// becomes an attribute of the group /lull/training. Throws std::invalid_argument for a network that
// CheckNetwork() or settings that CheckSettings() refuse and std::runtime_error if it cannot be
// written.
void WriteModel(const std::string& path, const Network& network, const ModelSettings& settings,
                const std::map<std::string, std::string>& record = {});

// Returns the blocks that a model was trained on, by viewpoint, as `record` had them in
// `training_blocks`: a line "VIEWPOINT: BLOCK BLOCK ..." for each. Empty where the file does not
// have them, as published models. Throws std::runtime_error beginning with the path.
std::map<std::string, std::vector<int>> ReadTrainingBlocks(const std::string& path);

}  // namespace lull
