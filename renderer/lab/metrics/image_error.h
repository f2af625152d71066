// Measures how far an image is from a reference, as a whole and by block.
#pragma once

#include <vector>

#include "renderer/film/film.h"
#include "renderer/image/rgb_image.h"
#include "renderer/vision/visible_difference.h"

namespace lull {

// Per-pixel errors that can be averaged over any part of an image; row-major.
struct ErrorMaps {
    int width = 0, height = 0;
    std::vector<float> squared;    // of linear values, the mean over R, G, B
    std::vector<float> relative;   // the same divided by reference^2 + 0.01
    std::vector<float> lightness;  // squared, of L in [0, 100] of the 8-bit display image
    std::vector<float> display;    // squared, of the 8-bit display values, the mean over R, G, B
    std::vector<float> ssim;       // ssim.h; NaN near the border
    std::vector<float> flip;       // flip.h, at the viewing distance it takes by default
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

}  // namespace lull
