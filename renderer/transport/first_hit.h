// The first hit of a path, for AOVs.
#pragma once

#include "renderer/base/math.h"

namespace lull {

// Describes a surface, or a point in a medium, which has no normal, object or material.
struct FirstHit {
    Rgb albedo = Rgb::Zero();        // in [0, 1]; where light is seen instead, that
    Vec3f normal = Vec3f::Zero();    // shading, unit, world, on the viewer's side
    Vec3f position = Vec3f::Zero();  // world
    float depth = 0;        // from the camera's plane along its axis; environment cameras: distance
    uint32_t object = 0;    // 1 + number of the shape, then of the instances; 0: none
    uint32_t material = 0;  // 1 + number of the material; 0: none
    bool found = false;     // there was one
    // Of the sample's radiance, that of a surface that the camera's ray meets unscattered.
    Rgb emission = Rgb::Zero();
    // Of the sample: its filter weight, and the squared distance from the pixel's centre.
    float weight = 1, offset2 = 0;
};

}  // namespace lull
