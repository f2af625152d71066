// Sums up the samples of every pixel: their colours and, in layers, what else is wanted of them.
#pragma once

#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "renderer/film/layer.h"
#include "renderer/film/layers.h"

namespace lull {

// Sums up samples of a tile: their noise, and what each strategy of light paths adds to it.
struct SampleSpread {
    double squares = 0;   // of luminance, about the means of its pixels
    int64_t freedom = 0;  // how many of these are independent
    int64_t samples = 0;
    double connected = 0;  // squares of the luminance that connections have found
    double light = 0;      // of that of light paths, one by one, in the round
};

// A coarse picture: one finite colour for each square of spacing x spacing pixels, row by row.
struct FirstLook {
    int spacing = 1;  // pixels, > 0
    std::vector<Rgb> colours;
    int eyeWidth = 0;  // as in TileGrid
};

// The means of a rectangle as criteria read them: row-major RGB triples. Reused from pass to pass.
struct FilmView {
    int width = 0, height = 0;
    std::vector<float> mean, halfMean;
};

// How a region is cut, from its upper left corner, into blocks, and these into tiles. The
// pixels of a tile have the same number of samples.
struct TileGrid {
    int blockSize = 1, tileSize = 1;  // pixels a side, > 0
    int eyeWidth = 0;  // where the right eye's image, cut by itself, follows; 0: there is one image
};

struct FilmOptions {
    TileGrid grid = {};        // by default every pixel is a tile of its own
    bool withHalf = true;      // keeps the sums of the half; false: they are zero and never read
    bool withSpreads = false;  // keeps those of tiles, for light paths
    LayerOptions layers = {};
};

class FilmTile;

// The pixels of the crop window, addressed by full-image coordinates: 24 bytes a pixel, 24
// more with the half, those of its layers, and 8 a tile. Different tiles can be changed by
// different threads at the same time.
class Film {
  public:
    explicit Film(const PixelRect& region, const FilmOptions& options = {});
    static int64_t Bytes(const PixelRect& region, const FilmOptions&);

    const PixelRect& Region() const { return sums.Region(); }
    bool HasHalf() const { return halfSums.has_value(); }
    void DropHalf() { halfSums.reset(); }

    // Returns a pixel; its `rejected` is 0, as those are counted by tile.
    FilmPixel At(const Vec2i& p) const;
    // Opens a rectangle of whole tiles of one sample count, to add as many to each pixel.
    FilmTile Tile(const PixelRect& pixels);

    // Sets the colours that means of pixels without samples have instead of black.
    void SetFirstLook(FirstLook look) { firstLook = std::move(look); }
    // Returns the mean of a pixel's samples; without any, the colour of the first look.
    Rgb MeanAt(const Vec2i& p) const;

    // Fills `view` with the means of `rect`, which lies inside Region(); `halfMean` is left empty
    // unless it is wanted. Throws std::logic_error if it is wanted and the film has no half.
    void Extract(const PixelRect& rect, bool withHalf, FilmView* view) const;

    // Returns the whole image, row-major RGB.
    std::vector<float> MeanImage() const;
    int64_t SampleCount() const;
    int64_t RejectedCount() const;

    // Returns the number of the tile that a pixel is in, row by row.
    size_t TileAt(const Vec2i& p) const {
        const Vec2i tile = TileOf(p);
        return size_t(tile.y()) * size_t(tiles.Region().Width()) + size_t(tile.x());
    }

    // Returns where the samples of a tile are summed up; null: they are not.
    SampleSpread* SpreadOf(const PixelRect& tile) {
        return spreads ? &spreads->At(TileOf(tile.min)) : nullptr;
    }
    // Return those of all tiles, which are kept, by their numbers; and begin again.
    const std::vector<SampleSpread>& Spreads() const { return spreads->Pixels(); }
    void ForgetSpreads() { spreads.emplace(tiles.Region()); }

    // Calls visit(name, plane, part) for each plane that a film, which may be const, consists of;
    // `part` is a rectangle of whole tiles, `pixels`, in the coordinates of the plane.
    template <typename AnyFilm, typename Visit>
    static void ForEachPlane(AnyFilm& film, const PixelRect& pixels, const Visit& visit) {
        visit("tiles", film.tiles, film.TilesIn(pixels));
        if (film.spreads) visit("spreads", *film.spreads, film.TilesIn(pixels));
        visit("sums", film.sums, pixels);
        if (film.halfSums) visit("sums of the half", *film.halfSums, pixels);
        film.layers.ForEach([&]<typename Kind>(Kind& kind) {
            Kind::ForEachPlane(kind,
                               [&](const char* name, auto& plane) { visit(name, plane, pixels); });
        });
    }

    Layers layers;

  private:
    friend class FilmTile;
    struct TileSamples {
        uint32_t count = 0;     // of each pixel
        uint32_t rejected = 0;  // of all pixels
    };
    using Sums = PixelPlane<std::array<double, 3>>;

    Vec2i TileOf(const Vec2i& p) const {
        const Vec2i at = p - Region().min;
        return {columns[size_t(at.x())], rows[size_t(at.y())]};
    }
    PixelRect TilesIn(const PixelRect& pixels) const {
        return {TileOf(pixels.min), TileOf(pixels.max - Vec2i(1, 1)) + Vec2i(1, 1)};
    }

    std::vector<int> columns, rows;  // tile of each column and row of pixels
    PixelPlane<TileSamples> tiles;
    std::optional<PixelPlane<SampleSpread>> spreads;
    Sums sums;
    std::optional<Sums> halfSums;
    FirstLook firstLook;  // no colours: none
};

// Append the pixels of whole tiles, and set them from bytes appended for the same planes.
// GetPlanes() throws std::runtime_error where the bytes end too early.
void PutPlanes(const Film&, const PixelRect& pixels, StateWriter*);
void GetPlanes(StateReader*, const PixelRect& pixels, Film*);

// Returns the names of all planes of the film, each with the identity of its layer.
std::map<std::string, std::string> PlanesOf(const Film&);

// Takes the pixels of a tile further, in any order. When it ends, the tile has as many samples as
// the pixels that were set, which are all.
class FilmTile {
  public:
    FilmTile(Film* film, const PixelRect& pixels);
    ~FilmTile();
    FilmTile(const FilmTile&) = delete;
    FilmTile& operator=(const FilmTile&) = delete;

    // Returns a pixel, with the count that it had when the tile was opened.
    FilmPixel At(const Vec2i& p) const { return film->At(p); }
    // Sets its sums, and adds the samples rejected since then to the tile's.
    void Set(const Vec2i& p, const FilmPixel&);

  private:
    Film* film;
    PixelRect tiles;
    uint32_t count;
};

}  // namespace lull
