// Reads the pixels that other programs show.
#pragma once

#include <stdexcept>
#include <string>
#include <vector>

#include "lull/lull.h"
#include "stopping/signals/lightness.h"

namespace lull {

// Throws std::invalid_argument unless the image has this size and a mean, a known format, rows
// that do not overlap, and a half if that is needed.
void CheckPicture(const lull_image& picture, int width, int height, bool needsHalf);

// Returns whether the half buffer of a part is nothing but its mean, which would be taken for an
// image without noise. Even colours, as of a sky, and 8 bits tell nothing, unless both are the same
// memory.
bool HasMeanAsHalf(const lull_image& picture, const lull_rect& part);

// Returns the part of an image that begins at `origin`, the mean or the half of a checked one, as
// a BlockView has it: linear R, G, B, row by row, finite. 8-bit codes become the middle of the
// range that is rounded to them, so that EncodeSrgb8() returns the same codes.
std::vector<float> ReadPixels(const lull_image& picture, const void* origin, const lull_rect& part);

// Returns the lightness, in [0, 100], of an image as an 8-bit display shows it. Throws
// std::invalid_argument for one that cannot be read: no size, no pixels, an unknown format.
std::vector<double> LightnessOf(const lull_image& picture);

// Returns whether the strides of an image leave room for a fourth channel.
bool HasFourthChannel(const lull_image& picture);

// Counts the values of a part of an image that begins at `origin`. None of 8-bit codes.
PictureValues ValuesOf(const lull_image& picture, const void* origin, const lull_rect& part);

// Throws std::invalid_argument, with nothing written, for what lull/lull.h does not allow.
void Denoise(const lull_noisy_image& noisy, lull_denoised_image* clean);

// Notices images of a block too far apart for rules that compare them, which never stop it then.

class PictureSpacing {
  public:
    // Returns the samples of the last three images, "64, 128 and 256", if the third has come when
    // it was asked for, could still not be checked, and each has 1.6 times the samples of the one
    // before or more; "" otherwise.
    std::string Note(const lull_answer& answer) {
        constexpr double kFar = 1.6;
        const bool isFar = before > 0 && last >= kFar * before && answer.spp >= kFar * last;
        const bool isMissed = !answer.stop && !answer.checked && answer.spp >= awaited;
        const std::string pictures = std::to_string(before) + ", " + std::to_string(last) +
                                     " and " + std::to_string(answer.spp);
        before = last;
        last = answer.spp;
        awaited = answer.next_spp;
        return isFar && isMissed ? pictures : "";
    }

  private:
    int before = 0, last = 0;  // spp
    int awaited = 0;
};

// Refuses what callers of the C interface hand over.

inline constexpr int kLargestSide = 1 << 16;  // pixels of an image

inline void Require(bool holds, const std::string& message) {
    if (!holds) throw std::invalid_argument(message);
}

}  // namespace lull
