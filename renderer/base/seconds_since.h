// Measures time as clocks on the wall have it.
#pragma once

#include <chrono>

namespace lull {

inline double SecondsSince(std::chrono::steady_clock::time_point start) {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

}  // namespace lull
