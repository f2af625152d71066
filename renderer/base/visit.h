// Dispatch over a closed set of kinds.
#pragma once

#include <cstddef>
#include <type_traits>
#include <variant>

namespace lull {

// Calls f with what the variant has, and returns what f returns: the same type for all kinds. Kinds
// before `First`, which f need not accept, must not be there. Unlike std::visit, which calls
// through a table of functions where there are more than eleven kinds, this is a single jump to
// code that is inlined: compilers make a switch of such comparisons. What f returns is made in its
// place.
template <size_t First = 0, typename Variant, typename F>
[[gnu::always_inline]] inline auto Visit(Variant& variant, F&& f) {
    if constexpr (First + 1 < std::variant_size_v<std::remove_const_t<Variant>>)
        if (variant.index() != First) return Visit<First + 1>(variant, f);
    return f(*std::get_if<First>(&variant));
}

}  // namespace lull
