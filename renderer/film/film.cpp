#include "renderer/film/film.h"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "renderer/base/error.h"

namespace lull {

namespace {

Rgb MeanOf(const std::array<double, 3>& sum, uint32_t count) {
    if (count == 0) return {0, 0, 0};
    return {float(sum[0] / count), float(sum[1] / count), float(sum[2] / count)};
}

void Store(const Rgb& c, float* to) {
    for (int i = 0; i < 3; ++i) to[i] = c[i];
}

std::vector<int> TilesAlong(int size, const TileGrid& grid, bool isAcross) {
    std::vector<int> tiles;
    int tile = -1;
    for (int i = 0; i < size; ++i) {
        const int at = isAcross && grid.eyeWidth > 0 ? i % grid.eyeWidth : i;
        tile += at % grid.blockSize % grid.tileSize == 0;
        tiles.push_back(tile);
    }
    return tiles;
}

int CountOf(const std::vector<int>& tiles) { return tiles.empty() ? 0 : tiles.back() + 1; }

}  // namespace

uint32_t HalfCount(uint32_t count) {
    // Two of every four; of the rest, the first or the second pair.
    const uint32_t whole = count & ~3u, rest = count & 3u;
    const uint32_t inFirstPair = std::min(rest, 2u);
    return whole / 2 + (InHalf(whole) ? inFirstPair : rest - inFirstPair);
}

Rgb FilmPixel::Mean() const { return MeanOf(sum, count); }

Rgb FilmPixel::HalfMean() const {
    const uint32_t half = HalfCount(count);
    return half > 0 ? MeanOf(halfSum, half) : Mean();
}

Film::Film(const PixelRect& region, const FilmOptions& options)
    : layers(region, options.layers),
      columns(TilesAlong(region.Width(), options.grid, true)),
      rows(TilesAlong(region.Height(), options.grid, false)),
      tiles({{0, 0}, {CountOf(columns), CountOf(rows)}}),
      sums(region) {
    if (options.withHalf) halfSums.emplace(region);
    if (options.withSpreads) ForgetSpreads();
}

int64_t Film::Bytes(const PixelRect& region, const FilmOptions& options) {
    constexpr int64_t kSumBytes = sizeof(std::array<double, 3>);
    const auto tilesAlong = [&](int size, bool isAcross) {
        return int64_t(CountOf(TilesAlong(size, options.grid, isAcross)));
    };
    return region.Area() *
               ((options.withHalf ? 2 * kSumBytes : kSumBytes) + Layers::Bytes(options.layers)) +
           tilesAlong(region.Width(), true) * tilesAlong(region.Height(), false) *
               int64_t(sizeof(TileSamples));
}

FilmPixel Film::At(const Vec2i& p) const {
    FilmPixel pixel{.sum = sums.At(p), .count = tiles.At(TileOf(p)).count};
    if (halfSums) pixel.halfSum = halfSums->At(p);
    return pixel;
}

Rgb Film::MeanAt(const Vec2i& p) const {
    const uint32_t count = tiles.At(TileOf(p)).count;
    if (count > 0 || firstLook.colours.empty()) return MeanOf(sums.At(p), count);
    const auto& [spacing, colours, eyeWidth] = firstLook;
    const int width = eyeWidth > 0 ? eyeWidth : Region().Width();
    const int perEye = (width + spacing - 1) / spacing, columns = perEye * Region().Width() / width;
    const Vec2i at = p - Region().min;
    const int column = at.x() / width * perEye + at.x() % width / spacing;
    return colours[size_t(at.y() / spacing) * size_t(columns) + size_t(column)];
}

FilmTile Film::Tile(const PixelRect& pixels) { return {this, pixels}; }

FilmTile::FilmTile(Film* film, const PixelRect& pixels)
    : film(film), tiles(film->TilesIn(pixels)), count(film->tiles.At(tiles.min).count) {}

FilmTile::~FilmTile() {
    for (int y = tiles.min.y(); y < tiles.max.y(); ++y)
        for (int x = tiles.min.x(); x < tiles.max.x(); ++x) film->tiles.At({x, y}).count = count;
}

void FilmTile::Set(const Vec2i& p, const FilmPixel& pixel) {
    film->sums.At(p) = pixel.sum;
    if (film->halfSums) film->halfSums->At(p) = pixel.halfSum;
    film->tiles.At(film->TileOf(p)).rejected += pixel.rejected;
    count = pixel.count;
}

void Film::Extract(const PixelRect& rect, bool withHalf, FilmView* view) const {
    if (withHalf && !HasHalf()) throw std::logic_error("the sums of the half are not kept");
    view->width = rect.Width();
    view->height = rect.Height();
    view->mean.resize(size_t(rect.Area()) * 3);
    view->halfMean.resize(withHalf ? size_t(rect.Area()) * 3 : 0);
    size_t at = 0;
    for (int y = rect.min.y(); y < rect.max.y(); ++y)
        for (int x = rect.min.x(); x < rect.max.x(); ++x, at += 3) {
            Store(MeanAt({x, y}), &view->mean[at]);
            if (withHalf) Store(At({x, y}).HalfMean(), &view->halfMean[at]);
        }
}

std::vector<float> Film::MeanImage() const {
    FilmView view;
    Extract(Region(), false, &view);
    return std::move(view.mean);
}

int64_t Film::SampleCount() const {
    int64_t n = 0;
    for (const int row : rows)
        for (const int column : columns) n += tiles.At({column, row}).count;
    return n;
}

int64_t Film::RejectedCount() const {
    int64_t n = 0;
    for (const TileSamples& tile : tiles.Pixels()) n += tile.rejected;
    return n;
}

void PutPlanes(const Film& film, const PixelRect& pixels, StateWriter* writer) {
    Film::ForEachPlane(film, pixels, [&](const char*, const auto& plane, const PixelRect& part) {
        plane.Put(part, writer);
    });
}

void GetPlanes(StateReader* reader, const PixelRect& pixels, Film* film) {
    Film::ForEachPlane(*film, pixels, [&](const char*, auto& plane, const PixelRect& part) {
        plane.Get(part, reader);
    });
}

std::map<std::string, std::string> PlanesOf(const Film& film) {
    std::map<std::string, std::string> planes = {{"sums", ""}};
    if (film.HasHalf()) planes["sums of the half"] = "";
    film.layers.ForEach([&]<typename Kind>(const Kind& kind) {
        Kind::ForEachPlane(kind, [&](const char* name, const auto&) {
            planes[name] = Kind::Identity(film.layers.Options());
        });
    });
    return planes;
}

namespace {

struct NamedLayer {
    const char* name;
    bool AovSet::*wanted;
};
constexpr NamedLayer kLayers[] = {{"albedo", &AovSet::albedo},
                                  {"normal", &AovSet::normal},
                                  {"depth", &AovSet::depth},
                                  {"position", &AovSet::position},
                                  {"object", &AovSet::object},
                                  {"material", &AovSet::material},
                                  {"noise", &AovSet::noise},
                                  {"alpha", &AovSet::alpha},
                                  {"cryptomatte", &AovSet::cryptomatte}};

}  // namespace

std::string NameOf(const AovSet& set) {
    std::string names;
    for (const NamedLayer& layer : kLayers) {
        if (!(set.*layer.wanted)) continue;
        if (!names.empty()) names += ',';
        names += layer.name;
    }
    return names;
}

std::string TextOf(const AovSet& set) {
    return NameOf(set) + (set.throughSpecular ? " through specular" : "");
}

std::string AllAovs(const char* separator) {
    std::string names;
    for (const NamedLayer& layer : kLayers)
        names.append(names.empty() ? "" : separator).append(layer.name);
    return names;
}

AovSet ParseAovs(const std::vector<std::string>& names) {
    AovSet set;
    for (const std::string& name : names) {
        const auto layer = std::ranges::find(kLayers, name, &NamedLayer::name);
        if (layer == std::end(kLayers))
            throw Error("there is no layer \"{}\", but {}, with commas between them", name,
                        AllAovs(", "));
        set.*layer->wanted = true;
    }
    return set;
}

}  // namespace lull
