#include "renderer/scene/geometry/shape.h"

namespace lull {

Emitter EmitterOf(const Geometry& geometry, uint32_t primitive) {
    return std::visit(
        [&]<typename S>(const S& shape) -> Emitter {
            if constexpr (std::is_same_v<S, Mesh>)
                return shape.EmitterAt(primitive);
            else if constexpr (std::is_constructible_v<Emitter, const S*>)
                return &shape;
            else
                throw Error("this kind of shape cannot emit light");
        },
        geometry);
}

uint32_t Shape::PrimitiveCount() const {
    return std::visit([](const auto& shape) { return shape.PrimitiveCount(); }, geometry);
}

Bounds3f Shape::WorldBounds() const {
    return std::visit([](const auto& shape) { return shape.WorldBounds(); }, geometry);
}

}  // namespace lull
