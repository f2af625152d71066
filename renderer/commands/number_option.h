// Checks the numbers of options, all of them: CLI11's own checks pass NaN, and whole numbers beyond
// their type's range.
#pragma once

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string>

namespace lull {

// Checks that a value is a number from `least` to `most`.
template <typename T>
CLI::Validator Between(T least, T most) {
    const CLI::Range range(least, most);
    const auto check = [=](std::string& text) -> std::string {
        T value;
        if (std::is_floating_point_v<T> && CLI::detail::lexical_cast(text, value) &&
            !std::isfinite(double(value)))
            return fmt::format("Value {} not in range [{} - {}]", text, least, most);
        return range(text);
    };
    return CLI::Validator(check, range.get_description());
}

// Checks that a value is a finite number above 0.
inline CLI::Validator AboveZero() {
    return Between(std::numeric_limits<double>::min(), std::numeric_limits<double>::max())
        .description("POSITIVE");
}

// Checks that a value is a whole number of up to 64 bits.
inline CLI::Validator WholeNumber() {
    const auto check = [](std::string& text) -> std::string {
        uint64_t value;
        const char* const end = text.data() + text.size();
        const auto [rest, error] = std::from_chars(text.data(), end, value);
        if (error == std::errc() && rest == end) return "";
        return fmt::format("{} is not a whole number from 0 to {}", text,
                           std::numeric_limits<uint64_t>::max());
    };
    return CLI::Validator(check, "NONNEGATIVE");
}

}  // namespace lull
