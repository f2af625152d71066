// Common part of the readers of image formats. This header is all that the module of other
// formats, which is loaded at run time, shares with the program.
#pragma once

#include <cstddef>

namespace lull {

enum class TexelType { Byte, Half, Float };

constexpr size_t SizeOf(TexelType type) {
    return type == TexelType::Byte ? 1 : type == TexelType::Half ? 2 : 4;
}

// Result of Read(): 8-bit, half and float texels as they are in the file, everything else
// as float (16-bit integers: 0 to 1).
struct ImageShape {
    int width = 0, height = 0;  // as the file says, however absurd
    int channels = 0;           // that are read; see CountChannels()
    TexelType type = TexelType::Byte;
};

// An image file of which only the header has been read.
class ImageFile {
  public:
    virtual ~ImageFile() = default;
    virtual ImageShape Shape() const = 0;
    // Reads all texels once: rows from the top, channels side by side, alpha unassociated. Throws
    // std::runtime_error with the reason, without the path.
    virtual void Read(void* texels) = 0;
    // Returns x and y of the chromaticities of red, green, blue and white of what Read() reads;
    // null where they are those of Rec. 709.
    virtual const float* Chromaticities() const { return nullptr; }
};

// Returns how many channels of a file are read: of 4 or more the first 4 if the last of these is
// alpha, else the first 3. `alpha` is the first alpha channel, or -1.
constexpr int CountChannels(int channels, int alpha) {
    return channels < 4 ? channels : alpha == 3 ? 4 : 3;
}

// The type of the module's one function, LullOpenImage: opens the file `path` or, if `bytes` is not
// null, these bytes, whose format is named by the extension of `path`. The bytes must outlive the
// result, which belongs to the caller. Throws std::runtime_error as Read() does.
using OpenImageFunction = ImageFile*(const char* path, const std::byte* bytes, size_t size);

// Common part of the colour management of images, shared by the module and the program.

// Maps colours to a display, as a view of an OpenColorIO configuration does.
class ViewTransform {
  public:
    virtual ~ViewTransform() = default;
    // Replaces linear R, G, B with the primaries of sRGB by encoded values, of which a display
    // shows 0 to 1. Infinite and NaN values are for the configuration to map.
    virtual void Apply(float* rgb, size_t pixels) const = 0;
    virtual const char* Name() const = 0;
};

// The type of the module's function LullOpenView: reads the configuration `path`, or $OCIO if that
// is empty, and takes the view of its default display, the default one if `view` is empty. The
// result belongs to the caller. Throws std::runtime_error with the reason.
using OpenViewFunction = ViewTransform*(const char* path, const char* view);

}  // namespace lull
