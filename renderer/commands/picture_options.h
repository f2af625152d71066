// Lets a render choose how its pictures are stored and shown.
#pragma once

#include <CLI/App.hpp>
#include <memory>
#include <optional>

#include "renderer/commands/talk.h"
#include "renderer/film/display.h"
#include "renderer/results/image_files.h"

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
                                     const PixelRect& region, int ranks, const Talk&);

}  // namespace lull
