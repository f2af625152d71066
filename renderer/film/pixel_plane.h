// Holds sums of any kind beside a Film, pixel by pixel.
#pragma once

#include <algorithm>
#include <vector>

#include "renderer/film/film.h"

namespace lull {

// Holds a Pixel, value-initialised, for each of a region. Different ones can be changed by
// different threads at the same time.
template <typename Pixel>
class PixelPlane {
  public:
    explicit PixelPlane(const PixelRect& region)
        : region(region), pixels(size_t(std::max<int64_t>(0, region.Area()))) {}

    const PixelRect& Region() const { return region; }
    Pixel& At(const Vec2i& p) { return pixels[Index(p)]; }
    const Pixel& At(const Vec2i& p) const { return pixels[Index(p)]; }
    const std::vector<Pixel>& Pixels() const { return pixels; }

    // Returns the pixels of a rectangle, row by row, and sets them.
    std::vector<Pixel> Copy(const PixelRect& rect) const {
        std::vector<Pixel> copy;
        for (int y = rect.min.y(); y < rect.max.y(); ++y) {
            const Pixel* row = &At({rect.min.x(), y});
            copy.insert(copy.end(), row, row + rect.Width());
        }
        return copy;
    }
    void Set(const std::vector<Pixel>& from, const PixelRect& rect) {
        for (int y = rect.min.y(); y < rect.max.y(); ++y)
            std::copy_n(&from[size_t(y - rect.min.y()) * size_t(rect.Width())], rect.Width(),
                        &At({rect.min.x(), y}));
    }

  private:
    size_t Index(const Vec2i& p) const {
        return size_t(p.y() - region.min.y()) * size_t(region.Width()) +
               size_t(p.x() - region.min.x());
    }

    PixelRect region;
    std::vector<Pixel> pixels;
};

}  // namespace lull
