// Recognises the channels of other programs' EXRs.
#pragma once

#include <functional>
#include <string>

#include "renderer/film/first_hit_layer.h"
#include "renderer/image/image_io.h"
#include "renderer/results/layer_channels.h"

namespace lull {

// Renames the channels that a denoiser needs to those of lull's own images: colours R, G, B and A
// from the only layer that has them, "LAYER.Combined" before others, or from a single Y; "albedo",
// "N" and "Z" from Blender's passes "Denoising Albedo", "Denoising Normal" or "Normal", "Denoising
// Depth" or "Depth". Channels that are there already stay. Throws Error with `file` and a list of
// its channels if there are no colours, or several.
void UseOwnNames(const std::string& file, ExrImage*);

// Throws Error with `file` and a list of its channels unless its colours are linear ones of Rec.
// 709: R, G and B of other primaries ("chromaticities"), or a Y that is one of X, Y and Z, of luma
// and chroma, or of inks.
void CheckColours(const std::string& file, const ExrImage&);

// Lists the names of channels for messages, the first of them where there are many.
std::string ListOfChannels(const ExrImage&);

// Stores which objects and materials cover each pixel as the Cryptomatte specification 1.2.0 says
// (J. Friedman, A. Jones, Psyop 2018), so that compositors make masks of their names.

// Returns the hash of a name: MurmurHash3's of 32 bits for x86, with seed 0.
uint32_t MurmurHash3(std::string_view name);

// Returns the hash of a name: one that, read as a float, is neither infinite, NaN nor denormal.
uint32_t CryptomatteId(std::string_view name);

// Returns six ranks of ids and coverage as channels LAYER00.R .G .B .A to LAYER02, of a member of
// the pixels, and the attributes that tell of them with a manifest of the names that occur. Numbers
// with the same name are one.
LayerChannels MakeCryptomatte(const std::string& layer, const MatteLayer&,
                              std::array<MatteShare, kMatteShares> CryptoPixel::*shares,
                              const std::function<std::string(uint32_t number)>& nameOf);

}  // namespace lull
