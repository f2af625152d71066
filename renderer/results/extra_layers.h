// Converts the layers of a render to channels and attributes of its EXR.
#pragma once

#include "renderer/film/aov_channels.h"
#include "renderer/film/light_group_film.h"
#include "renderer/film/matte_film.h"
#include "renderer/scene/compile.h"

namespace lull {

// Channels and attributes of an EXR in addition to its image.
struct ExtraLayers {
    std::vector<ExrChannel> channels;
    std::map<std::string, ExrAttribute> attributes;
    // R, G, B of each pixel in place of the image's, without its background; empty: none.
    std::vector<float> colours = {};
};

// Data that a render has collected in addition to its image; null: none.
struct CollectedLayers {
    const AovSet& wanted;
    const AovFilm* aovs;
    const MatteFilm* mattes;
    const LightGroupFilm* lights;  // AddLightLayers() adds them
};

// Removes the light of samples that hit nothing, `background`, from the colour of a pixel whose
// samples have this mean, and `covered` those that hit something. A denoised colour, which no
// sample has, is split as the mean is: the rest is neither negative nor more than the whole.
void RemoveBackground(double covered, double mean, double background, bool isDenoised,
                      float* colour);

// Returns the layers, and in the attributes "objectNames" and "materialNames", each a JSON object,
// the name of every number in the image: as in the scene, else kind, file and line. Cryptomattes
// have the same names.
ExtraLayers MakeExtraLayers(const CollectedLayers&, const Film&, const Description&, const Scene&);

}  // namespace lull
