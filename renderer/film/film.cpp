#include "renderer/film/film.h"

#include <stdexcept>

namespace lull {

namespace {

// Returns the mean of samples that add up to `sum`; black, where there are none.
Rgb MeanOf(const std::array<double, 3>& sum, uint32_t count) {
    if (count == 0) return {0, 0, 0};
    return {float(sum[0] / count), float(sum[1] / count), float(sum[2] / count)};
}

void Store(const Rgb& c, float* to) {
    for (int i = 0; i < 3; ++i) to[i] = c[i];
}

}  // namespace

uint32_t HalfCount(uint32_t count) {
    // Two of every four; of what is left over, the first or the second pair.
    const uint32_t whole = count & ~3u, rest = count & 3u;
    const uint32_t inFirstPair = std::min(rest, 2u);
    return whole / 2 + (InHalf(whole) ? inFirstPair : rest - inFirstPair);
}

Rgb FilmPixel::Mean() const { return MeanOf(sum, count); }

Rgb FilmPixel::HalfMean() const {
    const uint32_t half = HalfCount(count);
    return half > 0 ? MeanOf(halfSum, half) : Mean();
}

std::vector<Film::Place> Film::PlacesOf(int size, const TileGrid& grid) {
    std::vector<Place> places;
    uint32_t tile = 0;
    for (int i = 0; i < size; ++i) {
        const int inBlock = i % grid.blockSize + 1;
        const bool isLast =
            inBlock % grid.tileSize == 0 || inBlock == grid.blockSize || i + 1 == size;
        places.push_back({tile, isLast});
        tile += isLast;
    }
    return places;
}

Film::Film(const PixelRect& region, const FilmOptions& options)
    : region(region),
      hasHalf(options.withHalf),
      columns(PlacesOf(region.Width(), options.grid)),
      rows(PlacesOf(region.Height(), options.grid)),
      tilesInRow(columns.empty() ? 0 : columns.back().tile + 1),
      tiles(rows.empty() ? 0 : tilesInRow * (rows.back().tile + 1)),
      sums(columns.size() * rows.size()),
      halfSums(hasHalf ? sums.size() : 0) {}

int64_t Film::Bytes(const PixelRect& region, const FilmOptions& options) {
    constexpr int64_t sum = sizeof(std::array<double, 3>);
    const auto tilesAlong = [&](int size) {
        const std::vector<Place> places = PlacesOf(size, options.grid);
        return places.empty() ? 0 : int64_t(places.back().tile) + 1;
    };
    return region.Area() * (options.withHalf ? 2 * sum : sum) +
           tilesAlong(region.Width()) * tilesAlong(region.Height()) * int64_t(sizeof(Tile));
}

void Film::DropHalf() {
    hasHalf = false;
    decltype(halfSums)().swap(halfSums);  // an assigned list would leave its memory allocated
}

FilmPixel Film::At(const Vec2i& p) const {
    const size_t i = Index(p);
    const Place &column = columns[size_t(p.x() - region.min.x())],
                &row = rows[size_t(p.y() - region.min.y())];
    const Tile& tile = tiles[TileIndex(column, row)];
    FilmPixel pixel{sums[i], {}, tile.count, column.isLast && row.isLast ? tile.rejected : 0};
    if (hasHalf) pixel.halfSum = halfSums[i];
    return pixel;
}

void Film::Set(const Vec2i& p, const FilmPixel& pixel) {
    const size_t i = Index(p);
    const Place &column = columns[size_t(p.x() - region.min.x())],
                &row = rows[size_t(p.y() - region.min.y())];
    sums[i] = pixel.sum;
    if (hasHalf) halfSums[i] = pixel.halfSum;
    Tile& tile = tiles[TileIndex(column, row)];
    if (column.isLast && row.isLast)
        tile = {pixel.count, pixel.rejected};
    else
        tile.rejected += pixel.rejected;
}

void Film::Extract(const PixelRect& rect, bool withHalf, FilmView* view) const {
    if (withHalf && !hasHalf) throw std::logic_error("the sums of the half are not kept");
    view->width = rect.Width();
    view->height = rect.Height();
    view->mean.resize(size_t(rect.Area()) * 3);
    view->halfMean.resize(withHalf ? size_t(rect.Area()) * 3 : 0);
    size_t at = 0;
    for (int y = rect.min.y(); y < rect.max.y(); ++y)
        for (int x = rect.min.x(); x < rect.max.x(); ++x, at += 3) {
            const FilmPixel p = At({x, y});
            Store(p.Mean(), &view->mean[at]);
            if (withHalf) Store(p.HalfMean(), &view->halfMean[at]);
        }
}

template <typename Visit>
void Film::ForEachPixel(Visit visit) const {
    size_t i = 0;
    for (const Place& row : rows)
        for (const Place& column : columns) visit(i++, tiles[TileIndex(column, row)]);
}

std::vector<float> Film::MeanImage() const {
    std::vector<float> image(sums.size() * 3);
    ForEachPixel(
        [&](size_t i, const Tile& tile) { Store(MeanOf(sums[i], tile.count), &image[3 * i]); });
    return image;
}

std::vector<float> Film::SppImage() const {
    std::vector<float> image(sums.size());
    ForEachPixel([&](size_t i, const Tile& tile) { image[i] = float(tile.count); });
    return image;
}

int64_t Film::SampleCount() const {
    int64_t n = 0;
    ForEachPixel([&](size_t, const Tile& tile) { n += tile.count; });
    return n;
}

int64_t Film::RejectedCount() const {
    int64_t n = 0;
    for (const Tile& tile : tiles) n += tile.rejected;
    return n;
}

}  // namespace lull
