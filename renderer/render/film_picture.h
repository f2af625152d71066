// Converts a film to the inputs of the denoiser.
#pragma once

#include "renderer/denoise/denoiser.h"
#include "renderer/film/film.h"
#include "renderer/render/render.h"

namespace lull {

// Samples a pixel needs for both halves to have as many.
inline constexpr uint32_t kLeastDenoisedSpp = 4;

// Returns the pixels of a rectangle inside the film, which keeps its half and features. Where a
// pixel has less than kLeastDenoisedSpp samples, one half of its colours is their mean, and the
// other that of its neighbours; the denoiser's estimate of the error is too rough there to be used.
// Where it has none, both are the film's first look.
NoisyPicture PictureOf(const Film&, const PixelRect&);

// The same for the light of groups, which keep what tells their noise. The picture reads the film,
// which has to be there; the first look belongs to the last group.
GroupedPicture GroupedPictureOf(const Film&, const PixelRect&);

// Returns a region of the film at a lower resolution, for a quick look: each pixel is the mean of
// 2^halvings x 2^halvings.
NoisyPicture ReducedPictureOf(const Film&, const PixelRect& region, int halvings);

// Do the same for all pixels, and free what the denoiser alone reads of the film, row by row: so
// the picture takes its place.
NoisyPicture TakePicture(Film*);
GroupedPicture TakeGroups(Film*);

// Returns the colours alone.
Halves ColoursOf(const Film&, const PixelRect&);

// Return the features of both halves of the samples, not filtered, and the variance of the mean
// luminance.
Halves FeatureHalvesOf(const Film&, const PixelRect&);
// Returns NoisyPicture::emission: 0 in pixels with too few samples for two halves, no channels
// where the film has no such layer.
Halves EmissionOf(const Film&, const PixelRect&);
Planes VarianceOf(const Film&, const PixelRect&);

// Takes a first look at a picture, so that its first preview shows the whole of it.

// Gives the film a first look: sample 0 of one pixel in each square of 4 x 4, which takes 1/16 of
// the time of one sample per pixel. The samples of the film stay as they are. Without effect where
// all pixels have samples, or if the render is cancelled.
void TakeFirstLook(const SampleSource& source, const RenderOptions& options, Film* film);

}  // namespace lull
