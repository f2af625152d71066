// Sums of any kind, pixel by pixel.
#pragma once

#include <algorithm>
#include <vector>

#include "renderer/base/pixel_rect.h"
#include "stopping/base/state.h"

namespace lull {

// A Pixel, value-initialised, for each of a region. Different ones can be changed by
// different threads at the same time.
template <typename Pixel>
class PixelPlane {
  public:
    explicit PixelPlane(const PixelRect& region)
        : region(region), pixels(size_t(std::max<int64_t>(0, region.Area()))) {}

    const PixelRect& Region() const { return region; }
    Pixel& At(const Vec2i& p) { return pixels[Index(p)]; }
    const Pixel& At(const Vec2i& p) const { return pixels[Index(p)]; }
    const std::vector<Pixel>& Pixels() const { return pixels; }  // row by row

    // Appends the pixels of a rectangle inside the region as bytes, row by row.
    void Put(const PixelRect& rect, StateWriter* writer) const {
        for (int y = rect.min.y(); y < rect.max.y(); ++y)
            writer->PutAll(std::span(&At({rect.min.x(), y}), size_t(rect.Width())));
    }
    // Returns how many bytes that takes.
    static int64_t Bytes(const PixelRect& rect) { return rect.Area() * int64_t(sizeof(Pixel)); }
    // Restores the data of Put(). Throws std::runtime_error where the bytes end too
    // early.
    void Get(const PixelRect& rect, StateReader* reader) {
        for (int y = rect.min.y(); y < rect.max.y(); ++y)
            reader->GetAll(std::span(&At({rect.min.x(), y}), size_t(rect.Width())));
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
