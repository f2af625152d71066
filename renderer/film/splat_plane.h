// Sums up light that falls on pixels from light paths, as integers: the sums are the same bits in
// any order.
#pragma once

#include <array>
#include <atomic>
#include <cmath>
#include <cstdint>

#include "renderer/base/color.h"
#include "renderer/film/pixel_plane.h"

namespace lull {

// Sums in steps of a unit that the plane's owner knows.
struct SplatPixel {
    std::array<int64_t, 3> sum = {}, halfSum = {};
    int64_t squares = 0;  // of luminance
    uint64_t rejected = 0;
};

// The pixels of a film's region: 64 bytes a pixel.
class SplatPlane : public PixelPlane<SplatPixel> {
  public:
    // Values are about as large as `unit`, > 0, W/(m^2 sr): differences below 2^-24 of it are lost,
    // and values above 2^26 times it are taken as that.
    SplatPlane(const PixelRect& region, double unit)
        : PixelPlane(region), perStep(std::ldexp(unit, -kBits)), squaresPerStep(unit * unit / 64) {}

    // Adds to a pixel, from any thread.
    void Add(const Vec2i& p, const Rgb& radiance, bool inHalf) {
        constexpr double kMost = 0x1p50, kMostSquares = 0x1p54;
        SplatPixel& pixel = At(p);
        for (size_t c = 0; c < 3; ++c) {
            const auto steps = int64_t(std::llround(
                std::clamp(double(radiance[Eigen::Index(c)]) / perStep, -kMost, kMost)));
            if (steps == 0) continue;
            std::atomic_ref(pixel.sum[c]).fetch_add(steps, std::memory_order_relaxed);
            if (inHalf)
                std::atomic_ref(pixel.halfSum[c]).fetch_add(steps, std::memory_order_relaxed);
        }
        const double y = double(Luminance(radiance));
        const auto squares = int64_t(std::llround(std::min(y * y / squaresPerStep, kMostSquares)));
        std::atomic_ref(pixel.squares).fetch_add(squares, std::memory_order_relaxed);
    }

    // Counts light that was no number, or negative, from any thread.
    void Reject(const Vec2i& p) {
        std::atomic_ref(At(p).rejected).fetch_add(1, std::memory_order_relaxed);
    }

    // Adds the sums that another plane of the same unit has put (PixelPlane::Put()).
    void Merge(StateReader* reader) {
        SplatPlane other(Region(), 1);
        other.Get(Region(), reader);
        for (int y = Region().min.y(); y < Region().max.y(); ++y)
            for (int x = Region().min.x(); x < Region().max.x(); ++x) {
                SplatPixel& pixel = At({x, y});
                const SplatPixel& more = other.At({x, y});
                for (size_t c = 0; c < 3; ++c) {
                    pixel.sum[c] += more.sum[c];
                    pixel.halfSum[c] += more.halfSum[c];
                }
                pixel.squares += more.squares;
                pixel.rejected += more.rejected;
            }
    }

    // Light of a pixel, in W/(m^2 sr).
    struct Sums {
        std::array<double, 3> sum, halfSum;
        double squares;
    };
    Sums SumsAt(const Vec2i& p) const {
        const SplatPixel& pixel = At(p);
        Sums sums;
        for (size_t c = 0; c < 3; ++c) {
            sums.sum[c] = double(pixel.sum[c]) * perStep;
            sums.halfSum[c] = double(pixel.halfSum[c]) * perStep;
        }
        sums.squares = double(pixel.squares) * squaresPerStep;
        return sums;
    }

  private:
    static constexpr int kBits = 24;
    double perStep, squaresPerStep;
};

}  // namespace lull
