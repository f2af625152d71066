// Dispatch over a closed set of kinds.
#pragma once

#include <cstddef>
#include <type_traits>
#include <utility>
#include <variant>

namespace lull {

template <size_t First, size_t... I, typename Variant, typename F>
[[gnu::always_inline]] inline auto VisitAmong(std::index_sequence<I...>, Variant& variant, F& f) {
    using Result = decltype(f(*std::get_if<First>(&variant)));
    const size_t index = variant.index();
    if constexpr (std::is_void_v<Result>) {
        (void)((index == First + I && (f(*std::get_if<First + I>(&variant)), true)) || ...);
    } else {
        Result result{};
        (void)((index == First + I && (result = f(*std::get_if<First + I>(&variant)), true)) ||
               ...);
        return result;
    }
}

// Calls f with what the variant has, and returns what f returns: for all kinds the same type, which
// has a default. Kinds before `First`, which f need not accept, must not be there. Unlike
// std::visit, which calls through a table of functions where there are more than eleven kinds, this
// is a single jump to code that is inlined: compilers make a switch of such comparisons.
template <size_t First = 0, typename Variant, typename F>
[[gnu::always_inline]] inline auto Visit(Variant& variant, F&& f) {
    constexpr size_t kCount = std::variant_size_v<std::remove_const_t<Variant>> - First;
    return VisitAmong<First>(std::make_index_sequence<kCount>(), variant, f);
}

}  // namespace lull
