#include "renderer/scene/lights/environment_tiles.h"

#include <numeric>

namespace lull {

namespace {

constexpr int kBands = TileShares::kBands, kColumns = TileShares::kColumns;

// Divides elements into at most `most` parts of about the same weight, none of them empty, with a
// border before each element that weighs as much as a part. Returns where each begins, and the end.
std::vector<int> Divide(std::span<const double> weights, int most) {
    const int count = int(weights.size()), parts = std::min(most, count);
    const double total = std::accumulate(weights.begin(), weights.end(), 0.);
    std::vector<int> borders = {0};
    double running = 0;
    for (int i = 0; i < count && int(borders.size()) < parts; ++i) {
        const int made = int(borders.size());
        const bool mustNow = count - i == parts - made;  // else some part would be empty
        const bool isPart = weights[size_t(i)] >= total / parts;
        if (i > borders.back() && (mustNow || isPart || running >= total * made / parts))
            borders.push_back(i);
        running += weights[size_t(i)];
    }
    borders.push_back(count);
    return borders;
}

// Writes the running sums of weights, as those of probabilities.
void Sum(std::span<const float> weights, float* sums) {
    const Distribution1D distribution(weights);
    std::copy_n(distribution.Tables().cdf + 1, weights.size(), sums);
}

// Chooses an element; `u` in [0, 1) becomes the place in it, and `pmf` is multiplied by its
// probability.
int Choose(const float* sums, int count, float* u, float* pmf) {
    const int i = int(std::upper_bound(sums, sums + count - 1, *u) - sums);
    const float below = i == 0 ? 0 : sums[i - 1], width = sums[i] - below;
    *u = std::min((*u - below) / width, kOneMinusEpsilon);
    *pmf *= width;
    return i;
}

float Pmf(const float* sums, int i) { return i == 0 ? sums[0] : sums[i] - sums[i - 1]; }

}  // namespace

EnvironmentTiles::EnvironmentTiles(const BlockDistribution& map)
    : map(&map), counts(map.BlockCounts()), tiles(TileShares::kCount) {
    // Half a part is power, half is solid angle.
    std::vector<double> angles;  // of a block, by row
    for (int y = 0; y < counts.y(); ++y) {
        const double radians = double(kPi) / counts.y();
        angles.push_back((std::cos(radians * y) - std::cos(radians * (y + 1))) / 2 / counts.x());
    }
    const auto partOf = [&](int x, int y) { return double(map.BlockPmf({x, y})) + angles[y]; };
    std::vector<double> parts(counts.y());
    for (int y = 0; y < counts.y(); ++y)
        for (int x = 0; x < counts.x(); ++x) parts[y] += partOf(x, y);
    const std::vector<int> rows = Divide(parts, kBands);

    std::vector<float> power(TileShares::kCount, 0.f);
    columnSums.resize(size_t(counts.x()) * (rows.size() - 1));
    rowSums.resize(size_t(counts.x()) * size_t(counts.y()));
    tileOf.resize(columnSums.size());
    bandOf.resize(counts.y());
    for (int band = 0; band + 1 < int(rows.size()); ++band) {
        bands.push_back({rows[band], rows[band + 1]});
        const int height = rows[band + 1] - rows[band];
        std::fill_n(&bandOf[rows[band]], height, uint8_t(band));
        std::vector<float> columns(counts.x());
        parts.assign(counts.x(), 0);
        for (int x = 0; x < counts.x(); ++x) {
            std::vector<float> column;
            for (int y = rows[band]; y < rows[band + 1]; ++y) {
                column.push_back(map.BlockPmf({x, y}));
                columns[x] += column.back();
                parts[x] += partOf(x, y);
            }
            Sum(column, &rowSums[size_t(rows[band]) * counts.x() + size_t(height) * x]);
        }
        const std::vector<int> borders = Divide(parts, kColumns);
        for (int c = 0; c + 1 < int(borders.size()); ++c) {
            const int tile = band * kColumns + c, begin = borders[c], end = borders[c + 1];
            tiles[tile] = {int16_t(begin), int16_t(end)};
            const auto in = std::span(columns).subspan(begin, end - begin);
            power[tile] = std::accumulate(in.begin(), in.end(), 0.f);
            Sum(in, &columnSums[size_t(band) * counts.x() + begin]);
            std::fill_n(&tileOf[size_t(band) * counts.x() + begin], end - begin, uint16_t(tile));
        }
    }
    shares = TileShares(power);
}

Vec2f EnvironmentTiles::Sample(int tile, const Vec2f& u, float* pdf) const {
    const int band = tile / kColumns;
    const Tile& t = tiles[tile];
    Vec2f place = u;
    float pmf = 1;
    const float* sums = &columnSums[size_t(band) * counts.x() + t.begin];
    const int x = t.begin + Choose(sums, t.end - t.begin, &place.x(), &pmf);
    const Band& b = bands[band];
    const int y = b.begin + Choose(RowSums(band, x), b.end - b.begin, &place.y(), &pmf);
    const Vec2f st = map->SampleIn({x, y}, place, pdf);
    *pdf *= pmf;
    return st;
}

float EnvironmentTiles::Pdf(const Vec2f& st, int* tile) const {
    Vec2i block;
    const float pdf = map->PdfIn(st, &block);
    const int band = bandOf[block.y()];
    *tile = tileOf[size_t(band) * counts.x() + block.x()];
    const int begin = tiles[*tile].begin;
    return pdf * Pmf(&columnSums[size_t(band) * counts.x() + begin], block.x() - begin) *
           Pmf(RowSums(band, block.x()), block.y() - bands[band].begin);
}

}  // namespace lull
