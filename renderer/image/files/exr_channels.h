// Sorts the channels of an EXR, which are in alphabetical order there, as colours.
#pragma once

#include <string>
#include <vector>

namespace lull {

// Sorts "layer.name"s by layer, of which "" is the first, and those of a layer as OpenImageIO does:
// R, G, B, Y, A, Z and the like, then all others by name; if there is X with Y or Z: R, G, B, X, Y,
// Z, A, then all others.
void SortChannels(std::vector<std::string>* names);

// Returns whether "layer.name" is alpha.
bool IsAlpha(const std::string& name);

// Returns whether R, G and B, in no layer, are among the channels.
bool HasPlainColours(const std::vector<std::string>& names);

// Chooses the channels of a picture among sorted ones: R, G, B and A, of no layer before others and
// of "LAYER.Combined" before the rest; one of R, G and B that is missing, of two, is black. Without
// colours: the first channels, three at most, and alpha where it follows them. Throws
// std::runtime_error if colours are in several layers, or are luminance and chroma.
std::vector<std::string> PictureChannels(const std::vector<std::string>& sorted);

}  // namespace lull
