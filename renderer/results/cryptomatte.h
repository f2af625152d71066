// Stores which objects and materials cover each pixel as the Cryptomatte specification 1.2.0 says
// (J. Friedman, A. Jones, Psyop 2018), so that compositors make masks of their names.
#pragma once

#include <functional>
#include <string>

#include "renderer/film/matte_layer.h"
#include "renderer/results/layer_channels.h"

namespace lull {

// Returns the hash of a name: MurmurHash3's of 32 bits for x86, with seed 0.
uint32_t MurmurHash3(std::string_view name);

// Returns the hash that stands for a name: one that, read as a float, is neither infinite, NaN nor
// denormal.
uint32_t CryptomatteId(std::string_view name);

// Returns six ranks of ids and coverage as channels LAYER00.R .G .B .A to LAYER02, of a member of
// the pixels, and the attributes that tell of them with a manifest of the names that occur. Numbers
// with the same name are one.
LayerChannels MakeCryptomatte(const std::string& layer, const MatteLayer&,
                              std::array<MatteShare, kMatteShares> CryptoPixel::*shares,
                              const std::function<std::string(uint32_t number)>& nameOf);

}  // namespace lull
