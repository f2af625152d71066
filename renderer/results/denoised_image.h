// Denoises a finished render.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "renderer/denoise/denoise.h"
#include "renderer/denoise/denoiser.h"
#include "renderer/film/film.h"
#include "renderer/image/image.h"
#include "renderer/image/image_io.h"
#include "renderer/schedule/schedule.h"

namespace lull {

inline constexpr float kUnknownError = 100;  // in lightness, of pixels: all that is possible

// Returns where blocks are in the region.
std::vector<PixelRect> PlacesOf(const std::vector<Block>&, const PixelRect& region);

// Denoises the picture as a whole, so that there are no seams between blocks.
template <typename Picture>
DenoisedImage DenoiseImage(Picture picture, const PixelRect& region,
                           const std::vector<Block>& blocks, const DenoiserOptions& options = {}) {
    return RunDenoiser(std::move(picture), PlacesOf(blocks, region), options);
}

// Returns what denoise(region, blocks) makes of an image, or of each eye of a pair by itself, so
// that neither sees the other at the seam; as one image, side by side.
DenoisedImage DenoiseEyes(
    const PixelRect& region, const std::vector<Block>& blocks, int eyeWidth,
    const std::function<DenoisedImage(const PixelRect&, const std::vector<Block>&)>& denoise);

// Joins rows of both sides, with so many values each.
std::vector<float> RowsBeside(const std::vector<float>& left, const std::vector<float>& right,
                              size_t row);

// Denoises what there is of a region of a render for a quick look: a larger one at a lower
// resolution of at most so many pixels, so that it does not take minutes, and its errors are not
// known. Takes at most kPreviewBytes of memory a pixel if it is large.
inline constexpr int kPreviewBytes = 48;
DenoisedImage DenoisePreview(const Film&, const PixelRect& region, int64_t mostPixels = 2'000'000);

// Returns how large the visible errors of blocks probably are at most.
std::string TextOf(const std::vector<std::optional<VisibleError>>&,
                   double accepted = kAcceptedDifference);

// Description of R, G, B in the header of an EXR.
inline constexpr const char* kDenoisedNote =
    "R, G, B; noisy.R, .G, .B are the means of the samples";

// Returns channels R, G, B of a layer, "noisy." for instance, from the values of each pixel.
std::vector<ExrChannel> ColourChannels(const std::string& layer, std::span<const float> rgb);

// Returns the channels of an EXR besides the denoised R, G, B: noisy.R .G .B, the mean of
// the samples (R, G, B of each pixel), and `error`.
std::vector<ExrChannel> MakeDenoisedChannels(const DenoisedImage&, std::span<const float> noisy);

// Writes and reads the inputs of the denoiser as channels of an EXR.

// Returns the channels of an EXR from which ReadPicture() makes the same picture: halfA.R .G .B,
// halfA.albedo.R .G .B, halfA.N.X .Y .Z, halfA.disparity (one over the depth), halfA.emission.R .G
// .B (light seen directly), the same with halfB, and variance.Y.
std::vector<ExrChannel> MakeHalfChannels(const Film&, const PixelRect&);

inline constexpr int kHalfChannelsBytes = 27 * 4;  // of memory a pixel, of all of them

// Reads a picture from an EXR with these channels. Throws Error, with `name`, if any is missing.
NoisyPicture ReadPicture(const ExrImage&, const std::string& name);

// Makes a picture of two EXRs that hold different samples of the same, for instance renders with
// other seeds: R, G, B and, where both have them, albedo.R .G .B, N.X .Y .Z and Z. Throws Error if
// their sizes differ or R, G, B are missing.
NoisyPicture ReadPicture(const ExrImage& a, const std::string& nameOfA, const ExrImage& b,
                         const std::string& nameOfB);

}  // namespace lull
