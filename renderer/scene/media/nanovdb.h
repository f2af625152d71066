// Reads the grids of NanoVDB's files.
#pragma once

#include <optional>
#include <string>

#include "renderer/base/error.h"
#include "renderer/scene/media/grids.h"

namespace lull {

struct VdbGrid {
    SparseGrid grid;
    // Voxels are counted from the first value of the grid on.
    Mat4d voxelFromMedium;
    Vec3f low, high;  // the box of the active ones and their distance to the next, in voxels
};

// Reads the first grid of that name, of fog in floats; returns nothing where there is none. Files
// of format 32 (OpenVDB 8 and later) and 19 to 21 (Houdini 18.5), packed by ZIP or not. Throws
// Error that begins with `loc` for a file that cannot be read, and else with the path.
std::optional<VdbGrid> ReadNanoVdb(const std::string& path, const std::string& name,
                                   const FileLoc& loc);

}  // namespace lull
