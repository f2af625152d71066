// Adds options whose value is one of a closed set of names.
#pragma once

#include <CLI/CLI.hpp>
#include <map>
#include <string>

namespace lull {

// Checks that a value is one of the choices, without a word in the help: the type's name has them.
template <typename Choices>
CLI::Validator OneOf(const Choices& choices) {
    return CLI::IsMember(choices).description("");
}

// Adds an option that sets *value, which must outlive the parsing, to what `choices` has for the
// name that is given. What *value is before is the default that the help shows, and one of them;
// `names` are the choices in the order in which people read them, "off|auto|on".
template <typename T>
CLI::Option* AddChoiceOption(CLI::App& app, const std::string& option, T* value,
                             const std::map<std::string, T>& choices, const std::string& names,
                             const std::string& help) {
    std::string original;
    for (const auto& [name, choice] : choices)
        if (choice == *value) original = name;
    return app
        .add_option_function<std::string>(
            option, [=](const std::string& name) { *value = choices.at(name); }, help)
        ->check(OneOf(choices))
        ->type_name(names)
        ->default_str(original);
}

}  // namespace lull
