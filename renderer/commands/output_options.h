// Lets a render choose how its pictures are stored and shown.
#pragma once

#include <CLI/App.hpp>

#include <memory>
#include <optional>

#include "renderer/commands/command.h"
#include "renderer/film/display.h"
#include "renderer/film/layer.h"
#include "renderer/results/image_files.h"
#include "renderer/scene/scene.h"

namespace lull {

struct PictureOptions {
    PictureFormat format;
    // OpenColorIO's configuration, empty: $OCIO, and view; nothing: neither is used.
    std::optional<std::string> ocio, view;
    std::string display;  // empty: none
    double preview = 0;   // seconds between pictures on the way; 0: none
};

// Adds --tone-map, --ocio, --view, --view-exposure, --png-bits, --exr-half, --display and
// --preview.
void AddPictureOptions(CLI::App& app, PictureOptions* options);

// Loads the view of the format, where one is asked for. Throws Error.
void LoadView(PictureOptions*);

// Begins to show a render whose image is called `name`; null where that is not wanted. Throws Error
// on several ranks.
std::unique_ptr<Display> MakeDisplay(const PictureOptions&, const std::string& name,
                                     const PixelRect& region, int ranks, const Messages&);

// Options of layers: AOVs and groups of lights.

// Adds --aov and --aov-through-specular.
void AddAovOptions(CLI::App& app, AovSet* wanted);

// Adds --light-groups.
void AddLightGroupOption(CLI::App& app, std::vector<std::string>* names);

// Returns the groups of these names, none without any, as MakeLightGroups() does.
LightGroups ChooseLightGroups(const std::vector<std::string>& names, const Description&,
                              const Scene&);

}  // namespace lull
