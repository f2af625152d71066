// Draws veins of marble: a sine along y, disturbed by noise, coloured by a spline.
#pragma once

#include "renderer/scene/textures/octaves.h"

namespace lull {

struct Marble {
    Mapping3D mapping;
    float roughness;
    int octaves;
    float scale;
    float variation;  // how far noise shifts the sine, in radians
};

Rgb Evaluate(const Marble& marble, const TextureTable&, const TextureContext& c);

inline SurfaceNeeds Needs(const Marble&, const TextureTable&) { return kNeedsFootprint; }

inline Made<Rgb, Marble> MakeMarble(const TextureInput& input) {
    const Parameters& parameters = input.entity.parameters;
    return Marble{MakeMapping3D(input), parameters.GetFloat("roughness", 0.5f), GetOctaves(input),
                  parameters.GetFloat("scale", 1), parameters.GetFloat("variation", 0.2f)};
}

}  // namespace lull
