#include "renderer/bsdf/lobes.h"

namespace lull {
namespace {

template <typename L>
void Scale(L* lobe, const Rgb& s) {
    if constexpr (requires { lobe->scale; }) {
        lobe->scale *= s;
    } else {
        if constexpr (requires { lobe->r; }) lobe->r *= s;
        if constexpr (requires { lobe->t; }) lobe->t *= s;
    }
}
void Scale(std::monostate*, const Rgb&) {}

}  // namespace

Lobe Scaled(const Lobe& lobe, const Rgb& scale) {
    Lobe scaled = lobe;
    std::visit([&](auto& l) { Scale(&l, scale); }, scaled);
    return scaled;
}

}  // namespace lull
