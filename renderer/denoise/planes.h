// Images as planes, one per channel, for vector instructions.
#pragma once

#include <tbb/task_arena.h>
#include <Eigen/Core>

#include <algorithm>
#include <cstddef>
#include <limits>
#include <span>
#include <vector>

#include "renderer/base/math.h"
#include "renderer/base/memory.h"
#include "stopping/base/parallel.h"

namespace lull {

// `count` channels of width x height values, channel by channel, row by row from the top. They are
// 0 at first; those of large images take memory only where they are written.
struct Planes {
    int width = 0, height = 0, count = 0;
    std::vector<float, ZeroAllocator<float>> values;

    Planes() = default;
    Planes(int width, int height, int count)
        : width(width), height(height), count(count), values(Area() * size_t(count)) {}
    Planes(int width, int height, int count, float value)
        : width(width), height(height), count(count), values(Area() * size_t(count), value) {}

    size_t Area() const { return size_t(width) * size_t(height); }
    float* Plane(int c) { return values.data() + size_t(c) * Area(); }
    const float* Plane(int c) const { return values.data() + size_t(c) * Area(); }
    float* Row(int c, int y) { return Plane(c) + size_t(y) * size_t(width); }
    const float* Row(int c, int y) const { return Plane(c) + size_t(y) * size_t(width); }

    // Frees the rows [y0, y1), whose values become unknown.
    void ForgetRows(int y0, int y1) {
        for (int c = 0; c < count && y0 < y1; ++c)
            ForgetValues(std::as_bytes(std::span(Row(c, y0), Row(c, y1))));
    }
};

inline constexpr int kColours = 3;  // R, G, B

struct Halves {
    Planes a, b;
};
inline Halves MakeHalves(int width, int height, int count) {
    return {Planes(width, height, count), Planes(width, height, count)};
}

inline float LuminanceOf(const Planes& image, size_t i) {
    return Luminance(Rgb(image.Plane(0)[i], image.Plane(1)[i], image.Plane(2)[i]));
}

inline constexpr float kLargest = 1e18f;  // its square is finite

// Returns 0 for values that are negative or not finite, and at most kLargest.
inline float Sane(float x) {
    return x > 0 && x <= std::numeric_limits<float>::max() ? std::min(x, kLargest) : 0;
}

// Returns the values pixel by pixel, with adjacent channels.
std::vector<float> Interleaved(const Planes&);

// Returns half the squared difference of two images: of a value of either, where they differ by
// noise alone, the variance, with one degree of freedom.
Planes VarianceOf(const Planes& a, const Planes& b);

// Return the mean or the sum of each channel over the (2 radius + 1)^2 pixels around, those within
// the image. Each sum is computed afresh, so that a part of an image has the same bits as the
// whole, and bright pixels leave no rounding errors farther away.
Planes BoxMean(Planes, int radius);
Planes BoxSum(Planes, int radius);

// Computes the similarity of the neighbourhoods of pixels: the weights of non-local means (Buades,
// Coll and Morel 2005), corrected for the noise of each pixel (Rousselle, Knaus and Zwicker 2012).

// Cuts images into tiles whose pixels are computed sixteen side by side.

inline constexpr int kLanes = 16;  // pixels that are computed side by side
using Lanes = Eigen::Array<float, kLanes, 1>;
using LanesIn = Eigen::Map<const Lanes>;
inline void Store(const Lanes& values, float* to) { Eigen::Map<Lanes>{to} = values; }

// The pixels [x0, x1) x [y0, y1).
struct ImageTile {
    int x0, y0, x1, y1;

    ImageTile Grown(int margin) const {
        return {x0 - margin, y0 - margin, x1 + margin, y1 + margin};
    }
    ImageTile Within(int width, int height) const {
        return {std::max(x0, 0), std::max(y0, 0), std::min(x1, width), std::min(y1, height)};
    }
    // Returns the same pixels by their place in a crop of the image.
    ImageTile In(const ImageTile& crop) const {
        return {x0 - crop.x0, y0 - crop.y0, x1 - crop.x0, y1 - crop.y0};
    }
};

inline constexpr int kTileWidth = 128;

// Calls use(tile) for the tiles next to each other that these rows of an image are cut into, in any
// order, on all threads. How they are cut depends on nothing but the width.
template <typename Use>
void ForEachTile(int width, int y0, int y1, const Use& use) {
    // Isolated, so that a thread that waits here takes up no other task of a render.
    tbb::this_task_arena::isolate([&] {
        ForEachIndex((width + kTileWidth - 1) / kTileWidth, [&](int i) {
            const int x = i * kTileWidth;
            use(ImageTile{x, y0, std::min(x + kTileWidth, width), y1});
        });
    });
}

// Returns how many rows of an image are worked on at once: all of them if they are few, as in a
// block; the first of each is an even one.
inline int BandRows(int height) { return height <= 256 ? std::max(height, 1) : 128; }

// Does so for the tiles of all rows, band by band.
template <typename Use>
void ForEachTile(int width, int height, const Use& use) {
    const int rows = BandRows(height);
    for (int y = 0; y < height; y += rows) ForEachTile(width, y, std::min(height, y + rows), use);
}

inline Planes Crop(const Planes& image, const ImageTile& tile) {
    Planes part(tile.x1 - tile.x0, tile.y1 - tile.y0, image.count);
    for (int c = 0; c < part.count; ++c)
        for (int y = 0; y < part.height; ++y)
            std::copy_n(image.Row(c, tile.y0 + y) + tile.x0, part.width, part.Row(c, y));
    return part;
}

inline Halves Crop(const Halves& halves, const ImageTile& tile) {
    return {Crop(halves.a, tile), Crop(halves.b, tile)};
}

inline void Paste(const Planes& image, const ImageTile& tile, int x, int y, Planes* to) {
    for (int c = 0; c < image.count; ++c)
        for (int v = tile.y0; v < tile.y1; ++v)
            std::copy_n(image.Row(c, v) + tile.x0, tile.x1 - tile.x0,
                        to->Row(c, y + v - tile.y0) + x);
}

// Copy of the part of an image that a tile covers, whose rows can be read up to 4 kLanes past their
// end; where the tile lies beyond the image, the border is repeated.
class Cutout {
  public:
    Cutout(const ImageTile& tile, int count)
        : tile(tile), planes(tile.x1 - tile.x0 + 4 * kLanes, tile.y1 - tile.y0, count) {}
    Cutout(const ImageTile& tile, const Planes& image) : Cutout(tile, image.count) {
        for (int c = 0; c < image.count; ++c)
            for (int y = 0; y < planes.height; ++y) {
                const float* from = image.Row(c, std::clamp(tile.y0 + y, 0, image.height - 1));
                float* to = planes.Row(c, y);
                for (int x = 0; x < planes.width; ++x)
                    to[x] = from[std::clamp(tile.x0 + x, 0, image.width - 1)];
            }
    }

    // Returns where the value of a pixel is, by its place in the image.
    float* At(int c, int x, int y) { return planes.Row(c, y - tile.y0) + (x - tile.x0); }
    const float* At(int c, int x, int y) const {
        return planes.Row(c, y - tile.y0) + (x - tile.x0);
    }
    const ImageTile& Area() const { return tile; }
    int Count() const { return planes.count; }
    int Stride() const { return planes.width; }         // from a row to the next
    size_t PlaneSize() const { return planes.Area(); }  // from a channel to the next

  private:
    ImageTile tile;
    Planes planes;
};

// Image by which pixels are compared, and the variance of each of its values.
struct PatchGuide {
    const Planes& image;
    const Planes& variance;
};

struct PatchOptions {
    int radius = 9;       // pixels up to so far apart are compared, on either axis
    int patchRadius = 3;  // by the (2 patchRadius + 1)^2 pixels around them
};

// Measures, row by row of a tile and its border, the distance of the patches of two pixels: the
// mean over patch and channels of (u - u')^2 / (v + v') - 1, which is 0 on average for patches that
// differ by noise only. Where one of them has far more noise, v + v' is limited.
class PatchWeights {
  public:
    struct Offset {
        int x, y;
    };

    // Pixels up to `margin` outside of the tile can be asked for.
    PatchWeights(const PatchGuide&, const ImageTile&, int margin, const PatchOptions&);

    // The offsets of a window, row by row.
    const std::vector<Offset>& Offsets() const { return offsets; }

    // Makes y the row that is asked for. Rows come from top to bottom; some may be left out.
    void MoveTo(int y);

    // Returns the distances, not below 0, of the pixels (x, row) to (x + 15, row) from those at
    // offset number o; where these lie beyond the image, so large a number that nothing is left.
    Lanes Distances(int o, int x) const {
        const auto [dx, dy] = offsets[size_t(o)];
        if (row + dy < 0 || row + dy >= imageHeight) return Lanes::Constant(kBeyond);
        const LanesIn there(&beyond[size_t(x + dx - area.x0)]);
        if (o == halfCount) return there;
        const LanesIn d(o < halfCount ? DistancesAt(o, x, row)
                                      : DistancesAt(2 * halfCount - o, x + dx, row + dy));
        return d + there;
    }

    static Lanes WeightOf(const Lanes& distances, float bandwidth) {
        return (distances * (-1 / (bandwidth * bandwidth))).exp();
    }

  private:
    static constexpr float kBeyond = 1e6f;

    const float* DistancesAt(int o, int x, int y) const {
        return &distances[RingRow(o, y, distanceRows) + size_t(x - area.x0)];
    }
    // Returns where row y of offset number o begins in a ring that keeps the last `rows` of each.
    size_t RingRow(int o, int y, int rows) const {
        return size_t(o * rows + (y - area.y0) % rows) * stride;
    }
    void AddRow(int y);
    void MeasureRow(int y);

    std::vector<Offset> offsets;
    int halfCount;  // of the offsets before the one in the middle; number i and
                    // 2 halfCount - i are opposite, and have the same distances
    int radius, patchRadius, imageHeight;
    ImageTile area;
    Cutout image, variance;
    size_t stride;                         // of a row of the buffers below; the first is at area.x0
    std::vector<float> beyond;             // 0 at columns within the image, kBeyond outside
    int distanceRows, sumRows;             // that the rings have
    std::vector<float> distances;          // of the first half of the offsets
    std::vector<float> sums;               // of differences along the rows of patches
    std::vector<float> differences;        // of the row at hand
    int row = 0, nextSums, nextDistances;  // rows still to be made
};

}  // namespace lull
