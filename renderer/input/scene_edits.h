// Changes descriptions as the command line asks, whatever format they come from.
#pragma once

#include <string>
#include <vector>

#include "renderer/input/description.h"

namespace lull {

// Brightens all that the film records by 2 to the power of `stops`.
void SetExposure(double stops, Description* description);

// Replaces the integrator by "path", where the scene's sees media "volpath", or "bdpt".
void SetIntegrator(const std::string& name, Description* description);

// Has the camera render a pair, or one eye of it: numbers and names as in Stereo.
void SetStereo(const std::vector<float>& distanceAndConvergence, const std::string& eye,
               Description* description);

// Surrounds the scene by an image of the radiance from all directions, in latitude-longitude form,
// in place of its environment. The image's top is turned to glTF's up, or to the axis of the scene
// that is nearest to the camera's up; `rotation` turns it around that axis, in degrees,
// counterclockwise as seen from the top. `file` is relative to the current directory.
void SetEnvironment(const std::string& file, double rotation, Description* description);

// Lights a scene that has no light at all as a photographer's studio does, with a warning.
void LightIfDark(Description* description, Warnings& warnings);

}  // namespace lull
