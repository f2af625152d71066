// The image that shapes the beam of a light.
#pragma once

#include <memory>

#include "renderer/image/image.h"
#include "renderer/scene/lights/light_reader.h"

namespace lull {

struct LightImage {
    Image image;
    Rgb mean;  // of all texels

    // Returns the texels around st, interpolated; they repeat. The first row is at st.y() = 0.
    Rgb Lookup(const Vec2f& st) const;
};

// Reads "mapname"; null where there is none. As in pbrt-v3, 8-bit texels are taken as linear.
// Texels that are negative or not finite count as black, with a counted warning. Null substitutes
// an image that cannot be read.
std::shared_ptr<const LightImage> ReadLightImage(const LightReader&);

}  // namespace lull
