// Reads and writes image files. The formats are in files/; OpenImageIO is in a module of its own
// (renderer/formats), which is loaded for files that are neither PNG nor OpenEXR.
#pragma once

#include <algorithm>
#include <functional>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "renderer/base/variant.h"
#include "renderer/formats/formats.h"
#include "renderer/image/image.h"

namespace lull {

// Grades pictures: converts linear colours to those that a display shows.

// How radiance is fitted to the range of a display.
enum class ToneMap { None, Filmic };

template <>
struct EnumNames<ToneMap> {
    static constexpr std::pair<ToneMap, const char*> all[] = {{ToneMap::None, "none"},
                                                              {ToneMap::Filmic, "filmic"}};
};

// Applies the curve of J. Hable ("Filmic Tonemapping Operators", 2010; from Uncharted 2) to a
// linear component: toe and shoulder of film, with his constants, an exposure bias of 2 and a
// linear white of 11.2, which becomes 1. At least 0; NaN and negative values become 0.
inline float FilmicToneMap(float linear) {
    const auto curve = [](double x) {
        constexpr double A = 0.15, B = 0.50, C = 0.10, D = 0.20, E = 0.02, F = 0.30;
        return (x * (A * x + C * B) + D * E) / (x * (A * x + B) + D * F) - E / F;
    };
    // Beyond the bound the curve is flat.
    const double x = linear > 0 ? std::min(2 * double(linear), 1e6) : 0;
    return float(std::max(0., curve(x) / curve(11.2)));
}

// How linear colours become those that a display shows.
struct Grade {
    ToneMap toneMap = ToneMap::None;
    // Encodes the colours instead of sRGB and the tone map; null: none.
    std::shared_ptr<const ViewTransform> view = {};
    float exposure = 0;  // stops by which the colours are brightened before

    // Returns whether nothing is changed.
    bool IsPlain() const { return toneMap == ToneMap::None && !view && exposure == 0; }
};

// Returns "filmic (Hable 2010)", "OpenColorIO DISPLAY/VIEW", "+2 stops", or two of them; empty for
// a plain one.
std::string TextOf(const Grade&);

// Brightens linear R, G, B of each pixel and maps them by the view or the tone map. Returns whether
// they are encoded now, as a view does.
bool MapColors(const Grade&, std::span<float> rgb);

// Replaces linear R, G, B of each pixel by those that an sRGB display shows in the graded picture:
// finite, at least 0, above 1 only without tone map and view, and not rounded.
void ApplyGrade(const Grade&, std::span<float> rgb);

// Returns a view of the configuration file `config`, empty: $OCIO, for its default display; the
// default view if `view` is empty. Throws Error, with the names of the views if there is no such.
std::shared_ptr<const ViewTransform> LoadView(const std::string& config, const std::string& view);

// Reads the first image of a file: PNG, OpenEXR, or any other format that OpenImageIO knows. 8-bit,
// half and float texels stay as they are, everything else becomes float (16-bit integers: 0 to 1).
// Values are neither linearised nor multiplied by alpha. Of 4 or more channels the first 4 are read
// if the last of these is alpha, else the first 3. An EXR's display window is the image, which is 0
// outside the data window. Throws Error with the path and the reason, also for more than 2^16 a
// side, or a format whose module is not installed.
Image ReadImage(const std::string& path);

// Reads an image from memory; `type` is the extension of its format, "png" or "jpg" for instance,
// and `name` stands for the path in messages.
Image ReadImage(const std::string& name, const std::string& type, std::span<const std::byte> bytes);

// The largest finite number of 16 bits.
inline constexpr float kLargestHalf = 65504;

// One channel of an EXR, row-major over the data window.
struct ExrChannel {
    std::string name;
    std::vector<float> values;
    bool isHalf = false;  // stored in 16 bits, clamped to +-kLargestHalf
};

// A matrix is in pbrt's convention: applied to column vectors, stored row by row.
using ExrAttribute = std::variant<std::string, int, float, Mat4d>;

struct ExrImage {
    int width = 0, height = 0;     // of the data window
    Vec2i origin = Vec2i::Zero();  // of the data window, within the display window
    Vec2i displaySize{0, 0};       // the display window starts at (0, 0); 0: as the data window
    std::vector<ExrChannel> channels;
    std::map<std::string, ExrAttribute> attributes;
    // Read from files of several, such as those of two eyes: the first is that of the channels; the
    // names of others come before theirs, as in right.R.
    std::vector<std::string> views = {};

    // Returns the channel of that name, or null.
    const ExrChannel* Find(const std::string& name) const;
};

// Writes a scan-line EXR with ZIP compression, whole or not at all (see WriteFileAtomically).
// Returns how many values were clamped to 16 bits. Throws Error with the path and the reason.
int64_t WriteExr(const std::string& path, const ExrImage& image);

// Fills in row `y` of an image, 0 at the top, with adjacent channels. Is called from any thread.
using RowSource = std::function<void(int y, std::span<float> values)>;

// Does the same with channels of `image` that have no values: they come row by row.
int64_t WriteExr(const std::string& path, const ExrImage& image, const RowSource& rows);

// Writes images as the parts of a file, whose attributes "view" name them; `rows`: one of each.
int64_t WriteExr(const std::string& path, std::span<const ExrImage> parts,
                 std::span<const RowSource> rows);

// Reads an EXR with all its channels and those attributes that ExrAttribute can hold; other formats
// as ReadImage() does, as channels R, G, B, A or Y, A. Throws Error as that does.
ExrImage ReadExr(const std::string& path);

// Encodes linear RGB, rows from the top, as an 8-bit sRGB PNG: 255 times the transfer curve,
// rounded, clamped to [0, 255]; NaN is black. Throws Error.
std::vector<std::byte> EncodePng(std::span<const Rgb> pixels, int width, int height);

// Encodes 8-bit sRGB pixels (R, G, B, rows from the top), as small as PNG can. Throws Error.
std::vector<std::byte> EncodePng(std::span<const uint8_t> srgb, int width, int height);

// How a PNG shows linear RGB.
struct PngFormat {
    int bits = 8;  // a component, or 16
    Grade grade = {};
    // Rows have alpha as a fourth value, by which colours are multiplied; in the file they are not.
    bool hasAlpha = false;
    std::map<std::string, std::string> text = {};  // for the header: name (letters only), value
};

// Write PNGs, whole or not at all, of linear RGB, all or row by row, or of 8-bit sRGB. Throw Error.
void WritePng(const std::string& path, std::span<const Rgb> pixels, int width, int height,
              const PngFormat& format = {});
void WritePng(const std::string& path, const RowSource& rows, int width, int height,
              const PngFormat& format = {});
void WritePng(const std::string& path, std::span<const uint8_t> srgb, int width, int height);

// Returns the 8-bit display value of a linear value; NaN is black.
uint8_t Encode8Bit(float linear);

}  // namespace lull
