// Turns the sums of layers into the channels of an EXR.
#pragma once

#include "renderer/film/aov_film.h"
#include "renderer/film/film.h"
#include "renderer/image/image_io.h"

namespace lull {

// Z where nothing was hit, as in Blender's Cycles: far away, but finite, so that compositors can
// compute with it.
inline constexpr float kAovFarAway = 1e10f;

// Returns the channels of an EXR, with the samples that the film has of each pixel:
//   albedo.R .G .B   the share of light that is scattered, and N.X .Y .Z the normal: means over all
//                    samples, weighted by the pixel filter as the image is; 0 where nothing is
//   Z, P.X .Y .Z     depth and position: means over the samples that hit something; kAovFarAway and
//                    0 where none did
//   objectID,        of the sample nearest to the pixel's centre, as IDs cannot be averaged: a
//   materialID       matte without mixed edges; 0 where nothing was hit
//   noise            the standard error of the pixel in lightness: that of its luminance Y, from
//                    the samples' squares as if they were independent (for `sobol`, an upper
//                    bound), times the derivative of L = 116 cbrt(Y) - 16, which continues above
//                    white; 100 where there are less than two samples
std::vector<ExrChannel> MakeAovChannels(const AovFilm&, const Film&);

}  // namespace lull
