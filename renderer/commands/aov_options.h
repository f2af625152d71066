// Options of AOVs.
#pragma once

#include <CLI/App.hpp>

#include "renderer/film/film.h"

namespace lull {

// Adds --aov and --aov-through-specular.
void AddAovOptions(CLI::App& app, AovSet* wanted);

// Throws Error where the memory cannot hold these layers.
void CheckLayersFit(const LayerOptions&, const PixelRect& region);

}  // namespace lull
