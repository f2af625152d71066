// Loops over a closed set of kinds of which each may be missing, resolved at compile time.
#pragma once

#include <optional>
#include <tuple>

namespace lull {

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

}  // namespace lull
