// Estimates how much light reaches a voxel from each light, of which the choice of lights is made.
#pragma once

#include "renderer/scene/lights/light.h"

namespace lull {

// Places in a voxel, and samples of a light, one for each: a Halton set.
struct LightProbes {
    static constexpr int kCount = 128;
    using Numbers = Eigen::Array<float, kCount, 1>;
    using Places = Eigen::Array<float, kCount, 3>;

    LightProbes();
    Places PlacesIn(const Bounds3f& voxel) const;

    Places unit;                  // in the unit cube
    std::array<Vec2f, kCount> u;  // of samples
    Numbers b0, b1;               // the same as SampleUniformTriangle(u)
};

// Returns the sum over the places, world, of luminance over density of a sample each, without
// visibility.
float Contribution(const Light& light, const LightProbes& probes,
                   const LightProbes::Places& places);

}  // namespace lull
