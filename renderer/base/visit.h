// Dispatch over a closed set of kinds.
#pragma once

#include <cstddef>
#include <type_traits>
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

}  // namespace lull
