// Turns the layers of a render into what its EXR is given beside the image.
#pragma once

#include "renderer/film/aov_channels.h"
#include "renderer/film/matte_film.h"
#include "renderer/scene/compile.h"

namespace lull {

// What an EXR is given beside its image.
struct ExtraLayers {
    std::vector<ExrChannel> channels;
    std::map<std::string, ExrAttribute> attributes;
};

// What a render has collected besides its image; null: nothing.
struct CollectedLayers {
    const AovSet& wanted;
    const AovFilm* aovs;
    const MatteFilm* mattes;
};

// Returns the layers, and in the attributes "objectNames" and "materialNames", each a JSON object
// of the numbers in the image and what they stand for: names where the scene has them, else kind,
// file and line. Cryptomattes have the same names.
ExtraLayers MakeExtraLayers(const CollectedLayers&, const Film&, const Description&, const Scene&);

}  // namespace lull
