// Refuses what callers of the C interface hand over.
#pragma once

#include <stdexcept>
#include <string>

namespace lull {

inline constexpr int kLargestSide = 1 << 16;  // pixels of a picture

inline void Require(bool holds, const std::string& message) {
    if (!holds) throw std::invalid_argument(message);
}

}  // namespace lull
