// Options of AOVs.
#pragma once

#include <CLI/App.hpp>

#include "renderer/film/aov_channels.h"

namespace lull {

// Adds --aov and --aov-through-specular.
void AddAovOptions(CLI::App& app, AovSet* wanted);

// Throws Error where the memory cannot hold these layers, or a denoiser's `features`.
void CheckLayersFit(const AovSet& wanted, bool features, const PixelRect& region);

}  // namespace lull
