// Removes the excess of rare paths from pixels, and returns it to their region.
#pragma once

#include <vector>

#include "renderer/denoise/patch_weights.h"
#include "renderer/denoise/planes.h"

namespace lull {

// The energy removed from the mean of both half buffers.
struct Firefly {
    size_t pixel;  // several fireflies may share it
    Rgb excess;    // not negative
};

// Scales down each pixel of a half (R, G, B) that is brighter than the same pixel of the other half
// by more than `limit` times the standard deviation of such differences around, and brighter than
// all of its neighbours are there, to that limit. The lesser half may be exceeded by as much more
// as it is above the darkest neighbour: so a pixel bright in both halves, such as a glint, stays
// unchanged. With more samples, the energy removed vanishes as their noise does. Values are finite
// and not negative.
std::vector<Firefly> TakeFireflies(float limit, Halves*);

// Adds them to a picture: each over the 81 x 81 pixels around, in proportion to their brightness
// (up to white), where it is seen least. The sum over the picture grows by theirs, unless a few of
// them would change it too much: a pixel gets at most a 20th of its brightness from one, and more
// of as many more. Returns the standard deviation of what they brought, in luminance and at most
// that of the pixel, with that of what was not added: one event says as little of how many there
// are.
Planes GiveBack(const std::vector<Firefly>&, Planes* picture);

// Keeps fits from overshooting.

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
