// Reads the pixels that other programs show.
#pragma once

#include <vector>

#include "lull/lull.h"
#include "stopping/signals/picture_values.h"

namespace lull {

// Throws std::invalid_argument unless the picture has this size and a mean, a known format, rows
// that do not overlap, and a half if that is needed.
void CheckPicture(const lull_picture& picture, int width, int height, bool needsHalf);

// Returns whether the half buffer of a part is nothing but its mean, which would be taken for an
// image without noise. Even colours, as of a sky, and 8 bits tell nothing, unless both are the same
// memory.
bool HasMeanAsHalf(const lull_picture& picture, const lull_rect& part);

// Returns the part of a picture that begins at `origin`, the mean or the half of a checked one, as
// a BlockView has it: linear R, G, B, row by row, finite. 8-bit codes become the middle of the
// range that is rounded to them, so that EncodeSrgb8() returns the same codes.
std::vector<float> ReadPixels(const lull_picture& picture, const void* origin,
                              const lull_rect& part);

// Returns the lightness, in [0, 100], of a picture as an 8-bit display shows it. Throws
// std::invalid_argument for one that cannot be read: no size, no pixels, an unknown format.
std::vector<double> LightnessOf(const lull_picture& picture);

// Returns whether the strides of a picture leave room for a fourth channel.
bool HasFourthChannel(const lull_picture& picture);

// Counts the values of a part of a picture that begins at `origin`. None of 8-bit codes, all of
// which are possible.
PictureValues ValuesOf(const lull_picture& picture, const void* origin, const lull_rect& part);

}  // namespace lull
