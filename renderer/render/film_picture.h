// Shows the denoiser what a film has of a picture, and files what it needs to go on elsewhere.
#pragma once

#include <string>

#include "renderer/denoise/denoise.h"
#include "renderer/film/feature_film.h"
#include "renderer/film/film.h"
#include "renderer/image/image_io.h"

namespace lull {

// Samples a pixel needs for both halves to have some.
inline constexpr uint32_t leastDenoisedSpp = 4;

// Returns the pixels of a rectangle inside both films, which have the same samples; the film keeps
// its half. Where a pixel has less than leastDenoisedSpp samples, both halves are their mean, which
// the denoiser leaves alone.
NoisyPicture PictureOf(const Film&, const FeatureFilm&, const PixelRect&);

// Return its parts, so that a film that one of them is made of can be freed before the other is
// made: all but the colours, and these.
NoisyPicture FeaturesOf(const Film&, const FeatureFilm&, const PixelRect&);
Halves ColoursOf(const Film&, const PixelRect&);

// Returns the channels of an EXR from which ReadPicture() makes the same picture: halfA.R .G .B,
// halfA.albedo.R .G .B, halfA.N.X .Y .Z, halfA.disparity (one over the depth), the same with halfB,
// and variance.Y.
std::vector<ExrChannel> MakeHalfChannels(const Film&, const FeatureFilm&, const PixelRect&);

// Reads a picture from an EXR with these channels. Throws Error, with `name` in it, if any is
// missing.
NoisyPicture ReadPicture(const ExrImage&, const std::string& name);

// Makes a picture of two EXRs that hold different samples of the same, for instance renders with
// other seeds: R, G, B and, where both have them, albedo.R .G .B, N.X .Y .Z and Z. Throws Error if
// their sizes differ or R, G, B are missing.
NoisyPicture ReadPicture(const ExrImage& a, const std::string& nameOfA, const ExrImage& b,
                         const std::string& nameOfB);

}  // namespace lull
