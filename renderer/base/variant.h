// Dispatch over a closed set of kinds.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <tuple>
#include <type_traits>
#include <utility>
#include <variant>

namespace lull {

// Calls f with the alternative of the variant and returns its result, of the same type for
// all kinds. Kinds before `First`, which f need not accept, must not be active. Unlike
// std::visit, which uses a table of functions for more than eleven kinds, this is a single
// jump to inlined code: compilers make a switch of such comparisons. The result is
// constructed in place.
template <size_t First = 0, typename Variant, typename F>
[[gnu::always_inline]] inline auto Visit(Variant& variant, F&& f) {
    if constexpr (First + 1 < std::variant_size_v<std::remove_const_t<Variant>>)
        if (variant.index() != First) return Visit<First + 1>(variant, f);
    return f(*std::get_if<First>(&variant));
}

// Loops over a closed set of kinds of which each may be missing, resolved at compile time.

template <typename... Kinds>
using OptionalKinds = std::tuple<std::optional<Kinds>...>;

// Calls visit(optional) for each kind, in their order.
template <typename Kinds, typename Visit>
void ForEachOptional(Kinds& kinds, const Visit& visit) {
    std::apply([&](auto&... kind) { (..., visit(kind)); }, kinds);
}

// Calls visit(kind) for each kind that is there.
template <typename Kinds, typename Visit>
void ForEachPresent(Kinds& kinds, const Visit& visit) {
    std::apply([&](auto&... kind) { (..., (kind ? visit(*kind) : void())); }, kinds);
}

template <typename Kinds>
bool AreAllMissing(const Kinds& kinds) {
    return std::apply([](const auto&... kind) { return (... && !kind); }, kinds);
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
