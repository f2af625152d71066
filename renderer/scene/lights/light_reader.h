// Inputs of the functions that read lights.
#pragma once

#include "renderer/input/description.h"

namespace lull {

struct LightReader {
    const Description& description;  // relative file names start at its directory
    const LightEntity& entity;
    float worldRadius;   // of a sphere about the scene
    bool isCompensated;  // environment maps leave dim texels to BSDF sampling: EnvironmentMap
    Warnings& warnings;
};

// Returns the parameter "string lightgroup" of a LightSource or AreaLightSource, which RenderMan
// has under this name too; empty without one.
inline std::string LightGroupOf(const Entity& entity) {
    return entity.parameters.GetString("lightgroup", "");
}

}  // namespace lull
