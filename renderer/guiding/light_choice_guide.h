// Knows how much each of a few lights brings to a place, occlusion included: for each voxel of the
// scene and each side of surfaces in it a table of the lights.
#pragma once

#include <span>
#include <vector>

#include "renderer/base/memory.h"
#include "renderer/guiding/sides.h"
#include "renderer/guiding/square_sum.h"
#include "renderer/scene/lights/light_table.h"

namespace lull {

// Constant while paths are traced.
class LightChoiceGuide {
  public:
    LightChoiceGuide() = default;
    // Voxels are at most kMostVoxels along an axis, and fewer where a record of `lights` lights
    // would take more than kMostBytes. Nothing is known in any of them.
    LightChoiceGuide(const Bounds3f& bounds, int lights);

    // Returns the cell of the first light at p, on a side; others follow.
    size_t CellOf(const Vec3f& p, int side) const {
        return (grid.VoxelOf(p) * kSides + size_t(side)) * lightCount;
    }
    // Returns the running sums of the lights' probabilities (LightChoice) from such a cell on. They
    // stay where they are as long as the guide; the last one is 0 where nothing was learned.
    std::span<const float> At(size_t cell) const { return {&sums[cell], lightCount}; }
    // Starts to load them.
    void Prefetch(size_t cell) const {
        lull::Prefetch(&sums[cell]);
        lull::Prefetch(&sums[cell + lightCount - 1]);
    }

    bool IsEmpty() const { return sums.empty(); }

    static constexpr int kMostVoxels = 16;
    static constexpr size_t kMostBytes = 32 << 20;

    // To build and store it: tables of lights, by voxel, then side.
    VoxelGrid grid;
    size_t lightCount = 0;
    std::vector<float> sums;
};

// Returns whether all tables are of probabilities, or of zeros, as read from a file.
bool IsValid(const LightChoiceGuide&);

// Sums up what samples of lights have brought, for the next guide.
class LightChoiceRecord {
  public:
    LightChoiceRecord() = default;
    explicit LightChoiceRecord(const LightChoiceGuide& guide) : sums(guide.sums.size()) {}

    // Records a sample of a light, by its cell. `brought`: its luminance in the
    // image, relative to what a path usually brings, had the light been chosen for sure.
    void Add(size_t cell, float brought) { sums[cell].Add(brought, kLargest); }

    static constexpr float kLargest = 0x1p16f;  // of squares
    std::vector<SquareSum> sums;                // as LightChoiceGuide::sums
};

// Returns a guide that chooses each light by the root of the mean square of what its samples have
// brought, which is what has the least variance, in the voxels that samples were in. A part is
// chosen as without a guide, by `lights`.
LightChoiceGuide Learn(const LightChoiceGuide&, const LightChoiceRecord&, const LightTable& lights);

}  // namespace lull
