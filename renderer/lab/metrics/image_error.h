// Measures how far an image is from a reference, as a whole and by block.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "renderer/film/film.h"
#include "renderer/image/image.h"
#include "renderer/vision/visible_difference.h"

namespace lull {

// Per-pixel errors that can be averaged over any part of an image; row-major.
struct ErrorMaps {
    int width = 0, height = 0;
    std::vector<float> squared;    // of linear values, the mean over R, G, B
    std::vector<float> relative;   // the same divided by reference^2 + 0.01
    std::vector<float> lightness;  // squared, of L in [0, 100] of the 8-bit display image
    std::vector<float> display;    // squared, of the 8-bit display values, the mean over R, G, B
    std::vector<float> ssim;       // image_error.h; NaN near the border
    std::vector<float> flip;       // FlipMap(), at the viewing distance it takes by default
    VisibleDifference visibleDifference;  // of the 8-bit display images
};

// Compares two images; values that are not finite count as 0. Visible differences are those on
// `display`. Throws Error if sizes differ.
ErrorMaps CompareImages(const RgbImage& image, const RgbImage& reference,
                        const DisplayModel& display = {});

// Figures of an image or a part of it; NaN if one is not known. An infinite PSNR means that
// the display images are the same; ssim is NaN if no window lies inside the image.
struct ErrorFigures {
    double rmse = 0;    // of linear radiance
    double relMse = 0;  // mean of squared errors / (reference^2 + 0.01) [Rousselle et al. 2011]
    double rmseLightness = 0;  // of L, 0 to 100
    double psnr = 0;           // dB, of the 8-bit display image
    double ssim = 0, flip = 0;
    double visibleDifference = 0;  // visible_difference.h, pooled
};

// Averages the maps over `rect`, in pixels from the image's upper left corner; not empty.
ErrorFigures Average(const ErrorMaps&, const PixelRect& rect);
ErrorFigures Average(const ErrorMaps&);

// Measures whether borders of blocks are visible: noise jumps where blocks stop at different spp.

// Mean jumps of the noise level: the difference of the root mean squares of the noise in the 10
// pixels to either side of a line, over 20 pixels of its length. Even noise leaves the spread of
// the estimate; `inside` says how much that and the picture contribute.
struct Seams {
    double border = 0;  // across the borders between blocks
    double inside = 0;  // across the middle lines of the blocks, both ways
    // 1: borders are like the rest of the image; NaN where there is no border or no noise.
    double Ratio() const;
};

// Measures an image's noise: a signed value per pixel, such as the error of the lightness,
// row-major. Blocks are in pixels from the image's upper left corner. Lines less than 10 pixels
// from the next one are left out.
Seams MeasureSeams(std::span<const float> noise, int width, std::span<const PixelRect> blocks);

// Compares the structure of images: SSIM.

// Half the side of the window, which is 11 x 11 pixels.
inline constexpr int kSsimRadius = 5;

// Returns the structural similarity around each pixel, in [-1, 1] and 1 where both images are the
// same, of two images in 8-bit sRGB (R, G, B of the first pixel, row by row): Wang, Bovik, Sheikh,
// Simoncelli: Image Quality Assessment: From Error Visibility to Structural Similarity, IEEE
// Transactions on Image Processing 13(4), 2004, with its Gaussian window (standard deviation 1.5),
// K1 = 0.01 and K2 = 0.03, on the luma 0.299 R + 0.587 G + 0.114 B. NaN where the window would
// extend beyond the image, where the paper defines no value.
std::vector<float> SsimMap(std::span<const uint8_t> image, std::span<const uint8_t> reference,
                           int width, int height);

// Compares images as people do who flip between them: FLIP.

// Returns the pixels per degree of vision at the viewing conditions that the paper's program takes
// by default: 0.7 m before a display 0.7 m and 3840 pixels wide.
double DefaultPixelsPerDegree();

// Returns the difference that an observer sees at each pixel, in [0, 1] and 0 where both images are
// the same, of two images in 8-bit sRGB (R, G, B of the first pixel, row by row): Andersson,
// Nilsson, Akenine-Moller, Oskarsson, Astrom, Fairchild: FLIP: A Difference Evaluator for
// Alternating Images, Proceedings of the ACM on Computer Graphics and Interactive Techniques 3(2),
// 2020. The mean over the map is the figure for an image.
std::vector<float> FlipMap(std::span<const uint8_t> image, std::span<const uint8_t> reference,
                           int width, int height, double pixelsPerDegree);

}  // namespace lull
