// Interpolates between four values, one at each corner of the unit square of a mapping.
#pragma once

#include "renderer/scene/textures/mapping.h"

namespace lull {

template <typename T>
struct Bilerp {
    Mapping2D mapping;
    T v00, v01, v10, v11;  // at (s, t) = (0, 0), (0, 1), (1, 0), (1, 1); extrapolated outside
};

template <typename T>
T Evaluate(const Bilerp<T>& bilerp, const TextureTable&, const TextureContext& c) {
    const Vec2f st = Map(bilerp.mapping, c);
    const float s = st.x(), t = st.y();
    return (1 - s) * (1 - t) * bilerp.v00 + (1 - s) * t * bilerp.v01 + s * (1 - t) * bilerp.v10 +
           s * t * bilerp.v11;
}

template <typename T>
SurfaceNeeds Needs(const Bilerp<T>& bilerp, const TextureTable&) {
    return Needs(bilerp.mapping);
}

// Reads the corners, which are constants in pbrt-v3: textures are not looked up there.
template <typename T>
Made<T, Bilerp<T>> MakeBilerp(const TextureInput& input) {
    const auto corner = [&](const char* name, float otherwise) -> T {
        const Parameters& parameters = input.entity.parameters;
        if constexpr (std::is_same_v<T, float>)
            return parameters.GetFloat(name, otherwise);
        else
            return parameters.GetSpectrum(name, Rgb::Constant(otherwise));
    };
    return Bilerp<T>{MakeMapping2D(input), corner("v00", 0), corner("v01", 1), corner("v10", 0),
                     corner("v11", 1)};
}

}  // namespace lull
