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

}  // namespace lull
