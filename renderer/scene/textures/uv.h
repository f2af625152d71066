// Shows texture coordinates as red and green: for debugging parametrisations.
#pragma once

#include "renderer/scene/textures/mapping.h"

namespace lull {

struct UvColors {
    Mapping2D mapping;
};

inline Rgb Evaluate(const UvColors& uv, const TextureTable&, const TextureContext& c) {
    const Vec2f st = Map(uv.mapping, c);
    return {st.x() - std::floor(st.x()), st.y() - std::floor(st.y()), 0};
}

inline SurfaceNeeds Needs(const UvColors& uv, const TextureTable&) { return Needs(uv.mapping); }

inline Made<Rgb, UvColors> MakeUvColors(const TextureInput& input) {
    return UvColors{MakeMapping2D(input)};
}

}  // namespace lull
