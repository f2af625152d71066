#pragma once

#include <fmt/format.h>

#include <string>

#include "renderer/input/description.h"

namespace lull {

// Returns the colour of a light: its parameter `name` times "scale". Parts of it below 0, as
// colours outside of sRGB have, and numbers that are mistyped, count as black, with a warning.
inline Rgb LightColor(const Entity& entity, const std::string& name, Warnings& warnings) {
    const Parameters& params = entity.parameters;
    const Rgb color =
        params.GetSpectrum(name, Rgb::Ones()) * params.GetSpectrum("scale", Rgb::Ones());
    if (!(color < 0).any()) return color;
    warnings.Add(entity.loc, "a light has a negative part, which counts as black",
                 fmt::format("\"{}\" of \"{}\"", name, entity.name));
    return color.max(0.f);
}

}  // namespace lull
