// Writes PNGs of other kinds than 8-bit sRGB.
#pragma once

#include "renderer/output/image_io.h"
#include "renderer/output/tone_map.h"

namespace lull {

// Says how a PNG shows linear RGB.
struct PngFormat {
    int bits = 8;  // a component, or 16
    ToneMap toneMap = ToneMap::None;
    std::map<std::string, std::string> text = {};  // for the header: names of letters, and values
};

// Write PNGs of sRGB in this format, whole or not at all: as WritePng() does otherwise. Throw
// Error.
void WritePng(const std::string& path, std::span<const Rgb> pixels, int width, int height,
              const PngFormat& format);
void WritePng(const std::string& path, const RowSource& rows, int width, int height,
              const PngFormat& format);

}  // namespace lull
