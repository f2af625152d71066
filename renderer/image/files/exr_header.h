// Looks through the header of an OpenEXR file before the library does.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "renderer/base/math.h"

namespace lull {

// Converts linear colours of other primaries.

// Chromaticities x and y (CIE 1931) of linear R, G, B and of white, their sum.
struct Primaries {
    Vec2f red, green, blue, white;
};

// Returns the matrix that makes such colours those of Rec. 709, with white adapted to D65 as
// Bradford's. Not finite where the primaries are none.
Eigen::Matrix3f Rec709From(const Primaries& primaries);

// Multiplies the colours of an image of three channels or more by such a matrix. Parts of them that
// Rec. 709 lacks become 0: neither lights nor surfaces have negative ones.
template <typename T>
void Convert(const Eigen::Matrix3f& matrix, size_t channels, size_t pixels, T* texels) {
    for (size_t i = 0; i < pixels; ++i) {
        T* const c = texels + i * channels;
        const Vec3f given{float(c[0]), float(c[1]), float(c[2])}, color = matrix * given;
        const float least = given.minCoeff() >= 0 ? 0 : -kInfinity;
        for (int k = 0; k < 3; ++k) c[k] = T(std::max(color[k], least));
    }
}

// Sorts the channels of an EXR, which are in alphabetical order there, as colours.

// Sorts "layer.name"s by layer, of which "" is the first, and those of a layer as OpenImageIO does:
// R, G, B, Y, A, Z and the like, then all others by name; if there is X with Y or Z: R, G, B, X, Y,
// Z, A, then all others.
void SortChannels(std::vector<std::string>* names);

bool IsAlpha(const std::string& name);

// Returns whether R, G and B, in no layer, are among the channels.
bool HasPlainColours(const std::vector<std::string>& names);

// Chooses the channels of a picture among sorted ones: R, G, B and A, of no layer before others and
// of "LAYER.Combined" before the rest; one of R, G and B that is missing, of two, is black. Without
// colours: the first channels, three at most, and alpha where it follows them. Throws
// std::runtime_error if colours are in several layers, or are luminance and chroma.
std::vector<std::string> PictureChannels(const std::vector<std::string>& sorted);

// Throws std::runtime_error if the header is cut short, an attribute claims to be longer than the
// rest of the file, or the list of channels is not as long as it claims, so that the rest would be
// misread: the library would allocate as much, up to 2 GB, before it reads.
void CheckExrHeader(std::span<const std::byte> file);

}  // namespace lull
