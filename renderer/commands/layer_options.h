// Options of layers: AOVs and groups of lights.
#pragma once

#include <CLI/App.hpp>

#include "renderer/film/film.h"
#include "renderer/film/layer.h"
#include "renderer/scene/scene.h"

namespace lull {

// Adds --aov and --aov-through-specular.
void AddAovOptions(CLI::App& app, AovSet* wanted);

// Throws Error where the memory cannot hold a film with layers, the planes into which the denoiser
// turns them, and `more` bytes a pixel.
void CheckLayersFit(const FilmOptions&, const PixelRect& region, int64_t more = 0);

// Adds --light-groups.
void AddLightGroupOption(CLI::App& app, std::vector<std::string>* names);

// Returns the groups of these names, none without any, as MakeLightGroups() does. Throws Error also
// where the memory cannot hold the layers of the region with them.
LightGroups ChooseLightGroups(const std::vector<std::string>& names, const Description&,
                              const Scene&, LayerOptions, const PixelRect& region);

}  // namespace lull
