// Reads the arguments of stopping rules.
#pragma once

#include <charconv>
#include <cmath>
#include <stdexcept>
#include <string>

#include "stopping/base/input_file.h"

namespace lull {

// Parses all of `text` as a number > 0, finite. Throws std::invalid_argument with `needed`, the
// noun of such a number.
template <typename T>
T ParsePositive(const std::string& text, const std::string& needed) {
    T value = 0;
    const char* end = text.data() + text.size();
    const auto [rest, error] = std::from_chars(text.data(), end, value);
    if (error != std::errc() || rest != end || !(value > 0) || !std::isfinite(double(value)))
        throw std::invalid_argument("'" + Printable(text) + "' is not " + needed);
    return value;
}

inline double ParseThreshold(const std::string& text) {
    return ParsePositive<double>(text, "a threshold; a number > 0 is needed");
}

}  // namespace lull
