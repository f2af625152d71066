// Denoises a picture and measures its error: the one place where the program, its studies and its
// C library do so. Which algorithm does the work is known here alone.
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <string>

#include "renderer/denoise/visible_error.h"

namespace lull {

// Memory a pixel, in bytes, that the denoiser takes while it works: of a NoisyPicture, with that;
// of a GroupedPicture in addition; and of large pictures for lists and rows at hand.
inline constexpr int kDenoiserBytes = 92, kGroupsBytes = 104;
inline constexpr int kSmallestMeasuredSide = 10;  // pixels of a block whose error can be measured

struct DenoiserOptions {
    Effort effort = Effort::Full;
    bool withDeviation = true;  // measure the standard error of pixels, too
    // How the picture is shown when its error is measured: of a block the largest counts, of pixels
    // that of the first. None: the picture is shown as it is.
    std::vector<Grading> gradings = {};
    ShareListener onShare = {};  // of the filter, which takes 0.8 to 0.9 of the time
};

struct DenoisedImage {
    RgbImage image;
    std::vector<float> error;  // estimated standard error of each pixel in lightness
    // Of each block; not known of those below kSmallestMeasuredSide.
    std::vector<std::optional<VisibleError>> blocks;
    std::vector<std::vector<float>> groups = {};  // R, G, B of light groups, whose sum the image is
};

// Denoises a picture, whose memory it uses, and measures the error of blocks within it. The same
// bits for any number of threads.
DenoisedImage RunDenoiser(NoisyPicture, std::span<const PixelRect>, const DenoiserOptions& = {});

struct GroupedPicture {
    int groups = 1;   // > 0
    Planes features;  // as in NoisyPicture
    Planes variance;  // the same, of all light
    // Returns the light of a group, without features. Called once for each, one after the other.
    std::function<NoisyPicture(int group)> light;
};

// Denoises the groups one by one, each in the time of a picture. The errors of blocks are the
// largest: of the sum, or of a group.
DenoisedImage RunDenoiser(GroupedPicture, std::span<const PixelRect>, const DenoiserOptions& = {});

// Finds halves whose noise is not independent, which therefore cannot judge each other.

// Returns why two halves, R, G, B, of one size, are not independent, or "". Found are
//   - the same values, unless all pixels are alike, which have no noise;
//   - noise that both have: nowhere smooth, with the spectrum of noise, and more than three times
//     as strong as their difference, for which a picture of white noise is mistaken too;
//   - samples of one that the other has too, or six times as many samples.
// The second and third need some 12 tiles of 16 x 16 pixels in which there is anything to see.
std::string DependenceOf(const Halves&);

}  // namespace lull
