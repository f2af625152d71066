// Converts the layers of a render to channels and attributes of its EXR.
#pragma once

#include "renderer/film/aov_channels.h"
#include "renderer/film/matte_film.h"
#include "renderer/scene/compile.h"

namespace lull {

// Channels and attributes of an EXR in addition to its image.
struct ExtraLayers {
    std::vector<ExrChannel> channels;
    std::map<std::string, ExrAttribute> attributes;
};

// Data that a render has collected in addition to its image; null: none.
struct CollectedLayers {
    const AovSet& wanted;
    const AovFilm* aovs;
    const MatteFilm* mattes;
};

// Returns the layers, and in the attributes "objectNames" and "materialNames", each a JSON object,
// the name of every number in the image: as in the scene, else kind, file and line. Cryptomattes
// have the same names.
ExtraLayers MakeExtraLayers(const CollectedLayers&, const Film&, const Description&, const Scene&);

}  // namespace lull
