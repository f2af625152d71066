// Compares numbers of files, which exporters have rounded, with limits.
#pragma once

#include <algorithm>
#include <cmath>
#include <optional>

namespace lull {

// Relative error of a number that was rounded to float, or printed with six digits.
inline constexpr double kRounding = 1e-5;

// Returns whether `a` is above `b` by more than rounding.
inline bool IsAbove(double a, double b) {
    return a - b > kRounding * std::max(std::abs(a), std::abs(b));
}

// Returns x, clamped to the finite range, if it lies there or just as far outside as rounding the
// range's ends could take it; nothing for all else and NaN.
inline std::optional<double> InRange(double x, double least, double most) {
    const double slack = kRounding * std::max(std::abs(least), std::abs(most));
    if (!(x >= least - slack && x <= most + slack)) return {};
    return std::clamp(x, least, most);
}

// Returns a field of view in degrees, in (0, 180]; for 180, which needs an infinite image plane,
// 179.94. Nothing for all other numbers.
inline std::optional<double> FieldOfView(double degrees) {
    constexpr double kWidest = 179.94;
    const auto inRange = InRange(degrees, 0, 180);
    if (!inRange || !(*inRange > 0)) return {};
    return *inRange < 180 ? *inRange : kWidest;
}

// Returns x, and 0 for what rounding a 0 could leave below it; nothing for negative numbers and
// NaN.
inline std::optional<double> NotNegative(double x) {
    if (!(x >= -kRounding)) return {};
    return std::max(x, 0.0);
}

}  // namespace lull
