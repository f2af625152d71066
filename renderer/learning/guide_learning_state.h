// Keeps learning over an interruption.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "renderer/learning/guide_learning.h"

namespace lull {

// Packs all of it, with the layout of the machine it runs on.
std::vector<std::byte> SaveLearning(const Learning&);

// Restores the result of SaveLearning(). Throws std::runtime_error if the bytes are not of that:
// trees that lead nowhere, or in circles, are found.
Learning RestoreLearning(std::span<const std::byte>);

}  // namespace lull
