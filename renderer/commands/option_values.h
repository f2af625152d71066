// Options whose values are names, or numbers in a range. All options check their numbers by these:
// CLI11's own checks pass NaN, whole numbers beyond their type's range, hexadecimal and octal ones.
#pragma once

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <charconv>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "renderer/base/enum_names.h"
#include "stopping/base/input_file.h"

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

// Returns why a text is no number from `least` to `most` in decimal notation, "" if it is one.
// Whole numbers with zeros in front are none: CLI11 reads them as octal ones.
template <typename T>
std::string ProblemOfNumber(std::string_view text, T least, T most) {
    constexpr bool isWhole = std::is_integral_v<T>;
    const std::string quoted = Printable(text);
    if (text.starts_with('+') && !text.starts_with("+-")) text.remove_prefix(1);
    T value{};
    const char* const end = text.data() + text.size();
    const auto [rest, error] = std::from_chars(text.data(), end, value);
    const std::string_view digits = text.substr(text.starts_with('-') ? 1 : 0);
    const bool isOctal = isWhole && digits.size() > 1 && digits[0] == '0';
    if (error == std::errc::invalid_argument || rest != end || isOctal)
        return fmt::format("'{}' is not a {} such as {}", quoted,
                           isWhole ? "whole number" : "number", isWhole ? "20" : "0.5");
    const bool isWithin = error == std::errc() && value >= least && value <= most;
    return isWithin ? ""
                    : fmt::format("'{}' is not in the range from {} to {}", quoted, least, most);
}

// Checks that a value is a number from `least` to `most`.
template <typename T>
CLI::Validator Between(T least, T most) {
    return CLI::Validator(
        [=](const std::string& text) { return ProblemOfNumber(text, least, most); },
        CLI::Range(least, most).get_description());
}

// Checks that a value is a finite number above 0.
inline CLI::Validator AboveZero() {
    return Between(std::numeric_limits<double>::min(), std::numeric_limits<double>::max())
        .description("POSITIVE");
}

// Checks that a value is a whole number of up to 64 bits.
inline CLI::Validator WholeNumber() {
    return Between<uint64_t>(0, std::numeric_limits<uint64_t>::max()).description("NONNEGATIVE");
}

}  // namespace lull
