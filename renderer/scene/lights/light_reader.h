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

// Returns whether a matrix scales all axes alike, but for rounding.
inline bool ScalesEvenly(const Mat3f& m) {
    const Mat3f square = m * m.transpose();
    const float scale2 = square.trace() / 3;
    return (square - scale2 * Mat3f::Identity()).norm() <= 1e-4f * scale2;
}

}  // namespace lull
