// Converts the layers of a film (film/layers.h) to channels and attributes of an EXR.
#pragma once

#include "renderer/film/film.h"
#include "renderer/results/denoised_image.h"
#include "renderer/scene/scene.h"

namespace lull {

// Channels and attributes of an EXR in addition to its image.
struct LayerChannels {
    std::vector<ExrChannel> channels;
    std::map<std::string, ExrAttribute> attributes;
    // R, G, B of each pixel in place of the image's, without its background; empty: none.
    std::vector<float> colours = {};

    void Append(LayerChannels);
};

// What a layer's channels are made of, in addition to its sums.
struct FinishedFilm {
    const Film& film;
    const DenoisedImage* denoised = nullptr;  // null: the image is the means of the film
    bool isTransparent = false;               // the image lacks its background
    // Name the objects and materials of first hits.
    std::function<std::string(uint32_t)> nameOfObject = {}, nameOfMaterial = {};
};

// Z where nothing was hit, as in Blender's Cycles: finite, so that compositors can use it.
inline constexpr float kAovFarAway = 1e10f;

// Return the channels of each layer:
//   albedo.R .G .B   the share of light that is scattered, and N.X .Y .Z the normal: means over all
//                    samples, weighted by the pixel filter as the image is; 0 where nothing is
//   Z, P.X .Y .Z     depth and position: means over the samples that hit something; kAovFarAway and
//                    0 where none did
//   objectID,        of the sample nearest to the pixel's centre, as IDs cannot be averaged: a
//   materialID       matte without mixed edges; 0 where nothing was hit. Attributes "objectNames"
//                    and "materialNames", each a JSON object, have the name of every number in the
//                    image: as in the scene, else kind, file and line
LayerChannels ChannelsOf(const FirstHitLayer&, const FinishedFilm&);
//   noise            the standard error of the pixel in lightness: that of its luminance Y, from
//                    the samples' squares as if they were independent (for `sobol`, an upper
//                    bound), times the derivative of L = 116 cbrt(Y) - 16, which continues above
//                    white; 100 where there are less than two samples
LayerChannels ChannelsOf(const SquareLayer&, const FinishedFilm&);
//   none
inline LayerChannels ChannelsOf(const EmissionLayer&, const FinishedFilm&) { return {}; }
//   A                the coverage of the pixel; and Cryptomattes (channel_names.h)
LayerChannels ChannelsOf(const MatteLayer&, const FinishedFilm&);
//   light.NAME.R     of each group of lights, and .G .B: they add up to the image, and are
//   denoised,
//                    or lack the background, where it does; of the sum of denoised ones without it,
//                    which then is the image, `colours` has R, G, B. The names are attribute
//                    "lightGroups"
LayerChannels ChannelsOf(const LightGroupLayer&, const FinishedFilm&);

LayerChannels ChannelsOf(const FinishedFilm&);

// Removes the light of samples that hit nothing, of which `background` is the sum, from the colour
// R, G, B of a pixel. `covered` is the weight of those that hit something. A denoised colour, which
// no sample has, is split as the mean is: the rest is neither negative nor more than the whole.
void RemoveBackground(const FilmPixel& pixel, const std::array<double, 3>& background,
                      double covered, bool isDenoised, float* rgb);

}  // namespace lull
