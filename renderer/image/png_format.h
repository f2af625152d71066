// Writes PNGs with other bits, tones and colours than 8-bit sRGB.
#pragma once

#include "renderer/image/grade.h"
#include "renderer/image/image_io.h"

namespace lull {

// How a PNG shows linear RGB.
struct PngFormat {
    int bits = 8;  // a component, or 16
    Grade grade = {};
    // Rows have alpha as a fourth value, by which the colours are multiplied; in the file, as PNG
    // has it, they are not.
    bool hasAlpha = false;
    std::map<std::string, std::string> text = {};  // for the header: name (letters only), value
};

// Write PNGs in this format, whole or not at all, otherwise as WritePng() does. Throw Error.
void WritePng(const std::string& path, std::span<const Rgb> pixels, int width, int height,
              const PngFormat& format);
void WritePng(const std::string& path, const RowSource& rows, int width, int height,
              const PngFormat& format);

}  // namespace lull
