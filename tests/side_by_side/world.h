// Converts the view, lights and environment of a pbrt-v3 scene to glTF.
#pragma once

#include <string>

#include "renderer/base/error.h"
#include "renderer/input/description.h"
#include "tests/side_by_side/glb_file.h"

namespace lull {

// Returns the rotation of the scene's world into glTF's, whose y points up; it mirrors where the
// world is left-handed, as pbrt's is, so that the camera sees the same.
Mat4d GltfFromWorld(const Description& description);

// Adds the camera with its field of view. Throws Error for cameras that are not perspective; a lens
// is dropped with a warning.
void AddCamera(const Description& description, const Mat4d& gltfFromWorld, GlbFile* file,
               Warnings& warnings);

// Adds point, spot and distant lights; others are dropped with a warning. Spot lights fall off as
// in glTF.
void AddLights(const Description& description, const Mat4d& gltfFromWorld, GlbFile* file,
               Warnings& warnings);

// Writes the sum of the infinite lights as a latitude-longitude image for `--environment`. Returns
// whether there are any; otherwise nothing is written.
bool WriteEnvironment(const Description& description, const Mat4d& gltfFromWorld,
                      const std::string& path);

}  // namespace lull
