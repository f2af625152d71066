// Names ways to train a model: what it looks at, its network, and how that learns.
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

// Returns them, the default first: "entropy", that of the model that ships as the default, and
// "paper", that of Buisine et al. 2021.
std::span<const TrainingPreset> TrainingPresets();

}  // namespace lull
