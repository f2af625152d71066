// Options of AOVs.
#pragma once

#include <CLI/App.hpp>

#include "renderer/film/film.h"

namespace lull {

// Adds --aov and --aov-through-specular.
void AddAovOptions(CLI::App& app, AovSet* wanted);

// Throws Error where the memory cannot hold a film with layers, what is made of them in the end,
// and `more` bytes a pixel.
void CheckLayersFit(const FilmOptions&, const PixelRect& region, int64_t more = 0);

}  // namespace lull
