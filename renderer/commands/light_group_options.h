// Options of light groups.
#pragma once

#include <CLI/App.hpp>

#include "renderer/film/layer.h"
#include "renderer/scene/scene.h"

namespace lull {

// Adds --light-groups.
void AddLightGroupOption(CLI::App& app, std::vector<std::string>* names);

// Returns the groups of these names, none without any, as MakeLightGroups() does. Throws Error also
// where the memory cannot hold the layers of the region with them.
LightGroups ChooseLightGroups(const std::vector<std::string>& names, const Description&,
                              const Scene&, LayerOptions, const PixelRect& region);

}  // namespace lull
