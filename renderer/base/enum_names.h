// Names the values of an enum, once for options, headers and reports.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>

namespace lull {

// Names of the values of an enum: specialisations have `all`, each value with its name, in the
// order of help texts.
//
//     template <>
//     struct EnumNames<Weather> {
//         static constexpr std::pair<Weather, const char*> all[] = {{Weather::Dry, "dry"}, ...};
//     };
template <typename T>
struct EnumNames;

template <typename T>
requires std::is_enum_v<T> std::string NameOf(T value) {
    for (const auto& [named, name] : EnumNames<T>::all)
        if (named == value) return name;
    return "";
}

// Returns the value of that name; nothing if there is none.
template <typename T>
std::optional<T> ValueNamed(std::string_view name) {
    for (const auto& [value, known] : EnumNames<T>::all)
        if (known == name) return value;
    return {};
}

}  // namespace lull
