// Dispatch over a closed set of kinds.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <variant>

namespace lull {

// Calls f with the alternative of the variant and returns its result, of the same type for all
// kinds. Kinds before `First`, which f need not accept, must not be active. Unlike std::visit, with
// its table of functions for more than eleven kinds, this becomes a switch.
template <size_t First = 0, typename Variant, typename F>
[[gnu::always_inline]] inline auto Visit(Variant& variant, F&& f) {
    if constexpr (First + 1 < std::variant_size_v<std::remove_const_t<Variant>>)
        if (variant.index() != First) return Visit<First + 1>(variant, f);
    return f(*std::get_if<First>(&variant));
}

// Names the values of an enum, once for options, headers and reports.

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
