// Describes the image that is wanted: its size, crop and scale. (The film itself is in film/.)
#pragma once

#include <string>

#include "renderer/base/math.h"
#include "renderer/input/description.h"

namespace lull {

struct FilmSettings {
    Vec2i resolution = {1280, 720};  // of the whole image, pixels
    Vec2i cropMin = {0, 0};          // the pixels rendered: [cropMin, cropMax)
    Vec2i cropMax = {1280, 720};
    float diagonal = 0.035f;  // of the whole image on the film, metres (realistic cameras)
    std::string filename;     // empty: none is given
    float scale = 1;          // multiplies every sample, exposure included
    float exposure = 0;       // in stops
    float maxSampleLuminance = kInfinity;  // a brighter sample is scaled down to this

    Vec2i Size() const { return cropMax - cropMin; }
};

// Overrides of the scene's Film directive, from the command line.
struct FilmOverrides {
    std::optional<Vec2i> resolution;
    std::optional<std::array<float, 4>> crop;        // x0, x1, y0, y1 in [0, 1]
    std::optional<std::array<int, 4>> cropInPixels;  // instead: the pixels [x0, x1) x [y0, y1)
};

// Reads Film "image". Throws Error for sizes that are not positive or beyond 2^28 pixels.
FilmSettings MakeFilmSettings(const Description&, const FilmOverrides&, Warnings&);

}  // namespace lull
