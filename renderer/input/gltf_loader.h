// Reads glTF 2.0 files, .gltf and .glb.
#pragma once

#include <array>
#include <optional>
#include <string>

#include "renderer/base/error.h"
#include "renderer/input/description.h"

namespace lull {

struct GltfOptions {
    // Which camera to look through: the name of a camera or of the node that holds it, or its
    // number among the cameras in the scene, from 0. Empty: the first one.
    std::string camera = {};
    // Look at the whole scene instead, from this azimuth (degrees around the vertical, 0 from +z,
    // 90 from +x) and elevation (degrees above the horizon, -90 to 90).
    std::optional<std::array<float, 2>> orbit = {};
    // Pose the scene as an animation has it at this time, in seconds; nothing: as the file stands.
    std::optional<double> frame = {};
    std::string animation = {};  // which one: its name or number, from 0; empty: all
    // Let the shutter be open for so many seconds from then on: nodes and cameras that move are
    // blurred. At least 0; without `frame` nothing moves.
    double shutter = 0;
    std::string variant = {};  // which materials, by name or number, from 0; empty: the usual ones
    // Let all that transmits light be solid, as if the file gave it a volume.
    bool solidGlass = false;

    bool IsGiven() const {
        return !camera.empty() || orbit || frame || !variant.empty() || solidGlass;
    }
};

// Reads the scene in `file`. Throws Error, with the file and the JSON pointer, for anything wrong,
// or required but not supported; optional features lead to warnings.
Description ParseGltf(const std::string& file, const GltfOptions& options, Warnings& warnings);

// Returns whether a file is a glTF file, by its extension.
bool IsGltf(const std::string& file);

}  // namespace lull
