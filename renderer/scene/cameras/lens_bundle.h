// Traces many rays through the lenses of a camera at once, as wide as the processor's vectors are.
#pragma once

#include <array>
#include <span>

#include "renderer/scene/cameras/lens_system.h"

namespace lull {

// Each ray has its number in every array.
struct LensBundle {
    static constexpr size_t kMost = 64;
    using Values = std::array<double, kMost>;

    size_t count = 0;
    Values ox, oy, oz, dx, dy, dz;            // origins, directions
    std::array<Eigen::Vector2d, kMost> rear;  // where they were to meet the rear lens

    bool IsFull() const { return count == kMost; }
    // Adds a ray from a point of the film to one at the rear lens. There must be room.
    void Add(const Eigen::Vector3d& film, const Eigen::Vector3d& lens);
    // Follows all from the film to the scene and keeps those that get there, in their order.
    void TraceFromFilm(std::span<const LensInterface>);
};

}  // namespace lull
