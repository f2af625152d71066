// Options of layers: AOVs and groups of lights.
#pragma once

#include <CLI/App.hpp>

#include "renderer/film/aov_set.h"
#include "renderer/scene/scene.h"

namespace lull {

// Adds --aov and --aov-through-specular.
void AddAovOptions(CLI::App& app, AovSet* wanted);

// Adds --light-groups.
void AddLightGroupOption(CLI::App& app, std::vector<std::string>* names);

// Returns the groups of these names, none without any, as MakeLightGroups() does.
LightGroups ChooseLightGroups(const std::vector<std::string>& names, const Description&,
                              const Scene&);

}  // namespace lull
