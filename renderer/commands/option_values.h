// Options whose values are names, or numbers in a range. All options check their numbers by these:
// CLI11's own checks pass NaN, and whole numbers beyond their type's range.
#pragma once

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <charconv>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "renderer/base/enum_names.h"

namespace lull {

// Checks that a value is one of the choices, without a word in the help: the type's name has them.
template <typename Choices>
CLI::Validator OneOf(const Choices& choices) {
    return CLI::IsMember(choices).description("");
}

// Returns the names of an enum's values, and the same as the help shows them, "off|auto|on".
template <typename T>
std::vector<std::string> ChoicesOf() {
    std::vector<std::string> names;
    for (const auto& [value, name] : EnumNames<T>::all) names.push_back(name);
    return names;
}
template <typename T>
std::string ChoiceText() {
    std::string text;
    for (const std::string& name : ChoicesOf<T>()) text += (text.empty() ? "" : "|") + name;
    return text;
}

// Adds an option that sets *value, which must outlive the parsing, to the value of an enum that is
// named (EnumNames). The previous *value is the default in the help; a value that may be
// missing shows none.
template <typename T>
CLI::Option* AddChoiceOption(CLI::App& app, const std::string& option, std::optional<T>* value,
                             const std::string& help) {
    return app
        .add_option_function<std::string>(
            option, [value](const std::string& name) { *value = ValueNamed<T>(name); }, help)
        ->check(OneOf(ChoicesOf<T>()))
        ->type_name(ChoiceText<T>());
}
template <typename T>
CLI::Option* AddChoiceOption(CLI::App& app, const std::string& option, T* value,
                             const std::string& help) {
    return app
        .add_option_function<std::string>(
            option, [value](const std::string& name) { *value = *ValueNamed<T>(name); }, help)
        ->check(OneOf(ChoicesOf<T>()))
        ->type_name(ChoiceText<T>())
        ->default_str(NameOf(*value));
}

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
