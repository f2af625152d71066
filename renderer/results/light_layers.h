// Converts the light of groups to channels of the EXR.
#pragma once

#include "renderer/film/light_group_film.h"
#include "renderer/film/matte_film.h"
#include "renderer/results/denoised_image.h"
#include "renderer/results/extra_layers.h"

namespace lull {

// Adds channels light.NAME.R .G .B of each group, which add up to the image, and their names as
// attribute "lightGroups". They are denoised where the image is. With `mattes`, of an image without
// its background, they are without it too; of the sum of denoised ones, which then is the image,
// extra->colours has R, G, B.
void AddLightLayers(const LightGroupFilm&, const Film&, const DenoisedImage*,
                    const MatteFilm* mattes, ExtraLayers* extra);

}  // namespace lull
