// Lets a render choose how its pictures are stored and shown.
#pragma once

#include <CLI/App.hpp>
#include <memory>
#include <optional>

#include "renderer/output/display.h"
#include "renderer/output/png_format.h"

namespace lull {

struct PictureOptions {
    ToneMap toneMap = ToneMap::None;
    int pngBits = 8;
    bool exrHalf = false;
    std::string display;  // empty: none
};

// Adds --tone-map, --png-bits, --exr-half and --display.
void AddPictureOptions(CLI::App& app, PictureOptions* options);

// Returns the format of the PNG; its header tells of a tone map and of the scene's exposure, in
// stops.
PngFormat MakePngFormat(const PictureOptions&, double exposure);

// Changes an EXR as the options say: colours to 16 bits (but depths, positions, numbers and counts
// stay as they are), and a word on the PNG's tone map.
void ApplyTo(ExrImage* exr, const PictureOptions&);

// Begins to show a render whose image is called `name`; null where that is not wanted. Throws Error
// on several ranks.
std::unique_ptr<Display> MakeDisplay(const PictureOptions&, const std::string& name,
                                     const PixelRect& region, int ranks);

}  // namespace lull
