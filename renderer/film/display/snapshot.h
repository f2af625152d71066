// The latest state of an image, and its parts that have not been sent yet.
#pragma once

#include <mutex>
#include <optional>
#include <span>
#include <vector>

#include "renderer/film/film.h"

namespace lull {

// Used by all threads of a render and by the one that sends. The image is cut into cells; the
// changes of a cell are one rectangle, however often it changes before it is sent.
class Snapshot {
  public:
    static constexpr int kChannels = 5;  // R, G, B, spp, stop
    static constexpr int kCell = 64;     // pixels a side

    explicit Snapshot(const PixelRect& region);

    void Show(const PixelRect& pixels, const Film& film);
    // Shows these colours, R, G, B of each pixel, from now on in place of the film's.
    void ShowDenoised(const PixelRect& pixels, std::span<const float> rgb);
    void ShowStop(const PixelRect& block);
    // Marks everything that was ever shown as not sent.
    void ShowAllAgain();

    struct Update {
        PixelRect pixels;           // from the region's corner
        std::vector<float> values;  // row-major, kChannels a pixel
    };
    // Takes a rectangle that has changed and marks it as sent; false if there is none. Cells take
    // turns row by row. The memory of `values` is reused.
    bool Take(Update* update);

  private:
    float* At(int x, int y) { return &values[Index(x, y) * kChannels]; }
    size_t Index(int x, int y) const { return size_t(y) * size_t(width) + size_t(x); }
    void Mark(const PixelRect& pixels);

    std::mutex mutex;
    const PixelRect region;
    const int width, columns, rows;
    std::vector<float> values;
    std::vector<char> denoised;      // whether a pixel is shown so
    std::vector<PixelRect> changed;  // of each cell, from the region's corner
    std::vector<PixelRect> shown;    // the same, of all that was ever shown
    size_t next = 0;                 // the cell whose turn it is
};

}  // namespace lull
