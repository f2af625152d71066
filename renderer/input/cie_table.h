// Tabulates the CIE 1931 2-degree colour matching functions.
#pragma once

#include <array>

namespace lull {

inline constexpr int kCieFirst = 360, kCieLast = 830;  // nm, in steps of 1
inline constexpr int kCieRows = kCieLast - kCieFirst + 1;

struct CieRow {
    float x, y, z;
};

extern const std::array<CieRow, kCieRows> kCieTable;

}  // namespace lull
