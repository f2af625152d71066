// Named ways to train a model: its features, its network, and the training of that.
#pragma once

#include <span>
#include <string>

#include "stopping/lab/training/training.h"

namespace lull {

struct TrainingPreset {
    std::string name;
    ModelSettings settings = {};
    TrainingOptions training = {};
};

// Returns the presets, the default first: "entropy", for the model that ships as the default, and
// "paper", for Buisine et al. 2021.
std::span<const TrainingPreset> TrainingPresets();

}  // namespace lull
