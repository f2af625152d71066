// Writes and reads the inputs of the denoiser as channels of an EXR.
#pragma once

#include <string>
#include <vector>

#include "renderer/denoise/denoise.h"
#include "renderer/film/film.h"
#include "renderer/image/image_io.h"

namespace lull {

// Returns the channels of an EXR from which ReadPicture() makes the same picture: halfA.R .G .B,
// halfA.albedo.R .G .B, halfA.N.X .Y .Z, halfA.disparity (one over the depth), halfA.emission.R .G
// .B (light seen directly), the same with halfB, and variance.Y.
std::vector<ExrChannel> MakeHalfChannels(const Film&, const PixelRect&);

inline constexpr int kHalfChannelsBytes = 27 * 4;  // of memory a pixel, of all of them

// Reads a picture from an EXR with these channels. Throws Error, with `name` in it, if any is
// missing.
NoisyPicture ReadPicture(const ExrImage&, const std::string& name);

// Makes a picture of two EXRs that hold different samples of the same, for instance renders with
// other seeds: R, G, B and, where both have them, albedo.R .G .B, N.X .Y .Z and Z. Throws Error if
// their sizes differ or R, G, B are missing.
NoisyPicture ReadPicture(const ExrImage& a, const std::string& nameOfA, const ExrImage& b,
                         const std::string& nameOfB);

}  // namespace lull
