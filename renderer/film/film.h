// Sums up the samples of every pixel.
#pragma once

#include <span>
#include <vector>

#include "renderer/base/math.h"

namespace lull {

// Holds the pixels [min, max).
struct PixelRect {
    Vec2i min = {0, 0}, max = {0, 0};

    int Width() const { return max.x() - min.x(); }
    int Height() const { return max.y() - min.y(); }
    int64_t Area() const { return int64_t(Width()) * Height(); }
    bool operator==(const PixelRect& r) const { return min == r.min && max == r.max; }
};

// Says whether sample `index` belongs to the half on which noise is estimated: the bits at its
// odd places have odd parity. Any multiple of four samples, from 0 on, has exactly half in it,
// and both halves of a Sobol sequence stay well distributed (Cycles chooses the same way).
inline bool InHalf(uint32_t index) { return std::popcount(index & 0xaaaaaaaau) & 1; }

// Returns how many of the samples 0 .. count - 1 are in the half.
uint32_t HalfCount(uint32_t count);

// Holds the sums of a pixel. Samples arrive in the order of their indices, 0, 1, 2, ..., and are
// added to the running sums one by one, so that the sums are the same bits however the samples are
// cut into passes.
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
    // Return the mean of all samples, or of those in the half; without any, black, or the mean of
    // all.
    Rgb Mean() const;
    Rgb HalfMean() const;
};

// Holds the means of a rectangle of pixels as the stopping criteria read them: row-major RGB
// triples. Reused from pass to pass.
struct FilmView {
    int width = 0, height = 0;
    std::vector<float> mean, halfMean;
};

// Says how a region is cut, from its upper left corner, into blocks, and these into tiles. The
// pixels of a tile have the same number of samples.
struct TileGrid {
    int blockSize = 1, tileSize = 1;  // pixels a side, > 0
};

struct FilmOptions {
    TileGrid grid = {};    // by default every pixel is a tile of its own
    bool withHalf = true;  // keeps the sums of the half; false: they are zero and never read
};

// Holds the pixels of the crop window, addressed by full-image coordinates: 24 bytes a pixel, 24
// more with the half, and 8 a tile. Different tiles can be changed by different threads at the same
// time.
class Film {
  public:
    explicit Film(const PixelRect& region, const FilmOptions& options = {});
    // Returns the size of such a film in bytes.
    static int64_t Bytes(const PixelRect& region, const FilmOptions&);

    const PixelRect& Region() const { return region; }
    bool HasHalf() const { return hasHalf; }
    // Forgets the sums of the half.
    void DropHalf();

    // Return and set a pixel. A tile's sample count is stored with its last pixel, so all pixels of
    // a tile must be set, row by row. Rejected samples are counted by tile: At() returns them at
    // its last pixel, and Set() adds those of other pixels.
    FilmPixel At(const Vec2i& p) const;
    void Set(const Vec2i& p, const FilmPixel&);

    // Fills `view` with the means of `rect`, which lies inside Region(); `halfMean` is left empty
    // unless it is wanted. Throws std::logic_error if it is wanted and the film has no half.
    void Extract(const PixelRect& rect, bool withHalf, FilmView* view) const;

    // Return the whole image (row-major RGB) and the samples each pixel had.
    std::vector<float> MeanImage() const;
    std::vector<float> SppImage() const;
    int64_t SampleCount() const;
    int64_t RejectedCount() const;

    // Returns the number, below TileCount(), of the tile that a pixel is in.
    size_t TileAt(const Vec2i& p) const {
        return TileIndex(columns[size_t(p.x() - region.min.x())],
                         rows[size_t(p.y() - region.min.y())]);
    }
    size_t TileCount() const { return tiles.size(); }

  private:
    struct Tile {
        uint32_t count = 0, rejected = 0;
    };
    // Says which tile along an axis a coordinate is in, and whether it is the last in that tile.
    struct Place {
        uint32_t tile;
        bool isLast;
    };
    static std::vector<Place> PlacesOf(int size, const TileGrid&);

    // Calls visit(index, tile) for every pixel.
    template <typename Visit>
    void ForEachPixel(Visit) const;
    size_t Index(const Vec2i& p) const {
        return size_t(p.y() - region.min.y()) * size_t(region.Width()) +
               size_t(p.x() - region.min.x());
    }
    size_t TileIndex(const Place& column, const Place& row) const {
        return size_t(row.tile) * tilesInRow + column.tile;
    }

    PixelRect region;
    bool hasHalf;
    std::vector<Place> columns, rows;
    size_t tilesInRow;
    std::vector<Tile> tiles;
    std::vector<std::array<double, 3>> sums, halfSums;
};

}  // namespace lull
