// Keeps fits from overshooting.
#pragma once

#include "renderer/denoise/tile.h"

namespace lull {

// The least and the largest values that samples allow.
struct SampleRange {
    Planes least, most;

    void Clamp(Planes* picture) const;
};

// Returns, for the pixels of a tile within the image and channel by channel, the least sample of
// the 5 x 5 pixels around and the largest of the 15 x 15 pixels around. The latter are as many as a
// fit has: where few pixels have most of the light, those between them must be able to get it.
SampleRange RangeOfSamples(const Planes& noisy, const ImageTile&);

// Clamps each pixel of a picture as large as `noisy` to that range, tile by tile on all threads.
void ClampToSamples(const Planes& noisy, Planes* picture);

}  // namespace lull
