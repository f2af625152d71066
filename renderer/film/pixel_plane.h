// Sums of any kind, pixel by pixel.
#pragma once

#include <algorithm>
#include <memory>
#include <span>
#include <vector>

#include "renderer/base/pixel_rect.h"
#include "renderer/base/zero_values.h"
#include "stopping/base/state.h"

namespace lull {

// A Pixel, value-initialised, for each of a region. Different ones can be changed by
// different threads at the same time.
template <typename Pixel, typename Allocator = std::allocator<Pixel>>
class PixelPlane {
  public:
    explicit PixelPlane(const PixelRect& region)
        : region(region), pixels(size_t(std::max<int64_t>(0, region.Area()))) {}

    const PixelRect& Region() const { return region; }
    Pixel& At(const Vec2i& p) { return pixels[Index(p)]; }
    const Pixel& At(const Vec2i& p) const { return pixels[Index(p)]; }
    const auto& Pixels() const { return pixels; }  // row by row

    // Frees the rows [y0, y1) of the region, whose pixels become unknown.
    void ForgetRows(int y0, int y1) {
        const size_t width = size_t(region.Width()), first = size_t(y0 - region.min.y()) * width;
        if (y0 < y1)
            ForgetValues(std::as_bytes(std::span(pixels).subspan(first, size_t(y1 - y0) * width)));
    }

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
    std::vector<Pixel, Allocator> pixels;
};

}  // namespace lull
