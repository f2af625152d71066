// Adds options whose value is one of a closed set of names.
#pragma once

#include <CLI/CLI.hpp>
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

}  // namespace lull
