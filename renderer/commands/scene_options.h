// Holds what all commands that load a scene have in common.
#pragma once

#include <CLI/App.hpp>
#include <memory>

#include "renderer/output/film.h"
#include "renderer/scene/compile.h"

namespace lull {

struct SceneOptions {
    std::string file;
    CompileOptions compile;
};

// Adds SCENE, --resolution, --crop, --max-depth, --threads and --substitute.
void AddSceneOptions(CLI::App& app, SceneOptions* options);

// Prints warnings on stderr as they occur.
Warnings MakePrintedWarnings();

// Throws Error if the memory cannot hold a film of this size.
void CheckFilm(const PixelRect& region);

// Reads the scene's file. Throws Error.
Description LoadDescription(const SceneOptions&, Warnings&);

}  // namespace lull
