// What layers (layers.h) are made of: the sums that a user or a denoiser asks for, and samples.
#pragma once

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "renderer/base/math.h"
#include "renderer/base/memory.h"
#include "renderer/base/sampler.h"
#include "renderer/transport/integrator.h"
#include "stopping/base/state.h"
#include "stopping/signals/lightness.h"

namespace lull {

// Sums of any kind, pixel by pixel.

// Sums up the samples of a pixel.

// Returns how many of the samples 0 .. count - 1 are in the half.
uint32_t HalfCount(uint32_t count);

inline double Luminance(const std::array<double, 3>& sum) {
    const auto& [r, g, b] = kLuminanceWeights;
    return r * sum[0] + g * sum[1] + b * sum[2];
}

// The sums of a pixel. Samples are added one by one in the order of their indices, so that the sums
// are the same bits however they are cut into passes.
struct FilmPixel {
    std::array<double, 3> sum = {}, halfSum = {};
    uint32_t count = 0;
    uint32_t rejected = 0;  // samples that were NaN, infinite or negative, and count as black

    // Adds the sample of index `count`. The radiance must be finite.
    void Add(const Rgb& radiance, bool wasRejected) {
        const bool inHalf = InHalf(count);
        for (int c = 0; c < 3; ++c) {
            sum[c] += double(radiance[c]);
            if (inHalf) halfSum[c] += double(radiance[c]);
        }
        ++count;
        rejected += wasRejected;
    }
    // Return the mean of all samples (none: black), or of those in the half (none: of all).
    Rgb Mean() const;
    Rgb HalfMean() const;
};

// A Pixel, value-initialised, for each of a region. Threads can change different ones.
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
    static int64_t Bytes(const PixelRect& rect) { return rect.Area() * int64_t(sizeof(Pixel)); }
    // Restores the data of Put(). Throws std::runtime_error at their early end.
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

// Sums up light that falls on pixels from light paths, as integers: the sums are the same bits in
// any order.

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

// The AOVs that denoisers and compositors read ("arbitrary output variables").

struct AovSet {
    bool albedo = false, normal = false, depth = false, position = false, object = false,
         material = false, noise = false, alpha = false, cryptomatte = false;
    // Follow surfaces with only perfectly specular lobes to the next surface.
    bool throughSpecular = false;

    bool Any() const { return Hits() || noise || Mattes(); }
    // Return whether any is a property of first hits, and whether any is a coverage by them.
    bool Hits() const { return albedo || normal || depth || position || object || material; }
    bool Mattes() const { return alpha || cryptomatte; }
    bool operator==(const AovSet&) const = default;
};

// Names the AOVs: "albedo,normal,..." in the order above, without throughSpecular.
std::string NameOf(const AovSet&);
// Returns the same in words, with throughSpecular, for headers.
std::string TextOf(const AovSet&);

std::string AllAovs(const char* separator);

// Reads such names, in any order. Throws Error naming the first unknown one.
AovSet ParseAovs(const std::vector<std::string>& names);

// Which sums are wanted in addition to the colours of the film.
struct LayerOptions {
    AovSet aovs = {};
    bool features = false;         // for the denoiser: of first hits, and noise
    LightGroups groups = {};       // whose light is told apart
    bool groupNoise = false;       // for the denoiser: of each group
    bool groupBackground = false;  // the light of each group that meets nothing

    // Returns in words of which hits the AOVs are.
    const char* HitsText() const {
        return aovs.throughSpecular ? "through mirrors and glass" : "of the first surface";
    }
};

// Light that light paths bring to some samples of a pixel (render/light_rounds.h).
struct SplatLight {
    std::array<double, 3> sum = {}, halfSum = {};
    double squares = 0;  // of luminance, of single light paths
    double each = 0;     // the luminance that each sample gets of it
    double samples = 0;
    double camera = 0;  // the luminance of these samples without it

    // Returns the term for the squares of the samples' luminance, as of a Poisson process.
    double Squares() const { return squares + 2 * each * camera + samples * each * each; }
};

// The light of all groups of lights together, and of each where there are any.
struct PixelSplats {
    SplatLight all;
    std::span<const SplatLight> groups = {};
};

}  // namespace lull
