// Makes "constant" textures, which leave nothing to evaluate.
#pragma once

#include "renderer/scene/textures/texture_input.h"

namespace lull {

template <typename T>
TextureHandle<T> MakeConstant(const TextureInput& input) {
    if constexpr (std::is_same_v<T, float>)
        return {input.entity.parameters.GetFloat("value", 1)};
    else
        return {input.entity.parameters.GetSpectrum("value", Rgb::Constant(1))};
}

}  // namespace lull
