#include "renderer/denoise/denoise.h"

#include <cmath>
#include <iterator>

namespace lull {

namespace {

constexpr int kScaleRadius = 4;    // pixels, over which differences are measured
constexpr int kSpreadRadius = 20;  // of each of two box filters, one after the other
constexpr int kSpreadReach = 2 * kSpreadRadius;
constexpr int kBandRows = 256;          // over which what is taken is returned at a time
constexpr int kRounds = 2;              // as fireflies hide each other
constexpr float kMostReturned = 0.05f;  // of a pixel's brightness, by one firefly

struct Around {
    Planes least, most;
};

Around LuminancesAround(const Planes& image) {
    Planes y(image.width, image.height, 1);
    for (size_t i = 0; i < y.Area(); ++i) y.values[i] = LuminanceOf(image, i);
    Around around{y, y};
    for (int row = 0; row < y.height; ++row)
        for (int x = 0; x < y.width; ++x)
            for (int r = std::max(0, row - 1); r < std::min(y.height, row + 2); ++r)
                for (int q = std::max(0, x - 1); q < std::min(y.width, x + 2); ++q) {
                    const float value = y.Row(0, r)[q];
                    float &least = around.least.Row(0, row)[x], &most = around.most.Row(0, row)[x];
                    least = std::min(least, value);
                    most = std::max(most, value);
                }
    return around;
}

struct Bright {
    Planes Halves::*half;
    size_t pixel;
    float scale;
};

std::vector<Bright> FindIn(float limit, const Halves& halves, const ImageTile& tile) {
    const ImageTile crop = tile.Grown(kScaleRadius).Within(halves.a.width, halves.a.height);
    const Halves part = Crop(halves, crop);
    const Planes &a = part.a, &b = part.b;
    Planes distance(a.width, a.height, 1);
    for (size_t i = 0; i < a.Area(); ++i)
        distance.values[i] = std::abs(LuminanceOf(a, i) - LuminanceOf(b, i));
    const Planes around = BoxSum(distance, kScaleRadius);
    const Planes counts = BoxSum(Planes(a.width, a.height, 1, 1), kScaleRadius);
    const Around ofA = LuminancesAround(a), ofB = LuminancesAround(b);
    std::vector<Bright> found;
    const auto compare = [&](Planes Halves::*half, int x, int y, float luminance, float limit) {
        if (luminance > limit)
            found.push_back(
                {half, size_t(y) * size_t(halves.a.width) + size_t(x), limit / luminance});
    };
    for (int y = tile.y0; y < tile.y1; ++y)
        for (int x = tile.x0; x < tile.x1; ++x) {
            const size_t i = size_t(y - crop.y0) * size_t(a.width) + size_t(x - crop.x0);
            // The mean of |x| is sqrt(2 / pi) standard deviations; without the pixel itself.
            const float others = std::max(0.f, around.values[i] - distance.values[i]) /
                                 std::max(1.f, counts.values[i] - 1);
            const float reach = limit * 1.2533f * others;
            const float ya = LuminanceOf(a, i), yb = LuminanceOf(b, i);
            // A lamp or glint of a pixel is bright in both halves, and may differ by as much.
            const float agreed = std::max(
                0.f, std::min(ya, yb) - std::min(ofA.least.values[i], ofB.least.values[i]));
            compare(&Halves::a, x, y, ya, std::max(yb + reach + agreed, ofB.most.values[i]));
            compare(&Halves::b, x, y, yb, std::max(ya + reach + agreed, ofA.most.values[i]));
        }
    return found;
}

std::vector<Bright> Find(float limit, const Halves& halves) {
    const int width = halves.a.width, height = halves.a.height;
    std::vector<std::vector<Bright>> columns(size_t(width / kTileWidth + 1));
    ForEachTile(width, height, [&](const ImageTile& tile) {
        const std::vector<Bright> found = FindIn(limit, halves, tile);
        std::ranges::copy(found, std::back_inserter(columns[size_t(tile.x0 / kTileWidth)]));
    });
    std::vector<Bright> all;
    for (const std::vector<Bright>& column : columns)
        all.insert(all.end(), column.begin(), column.end());
    return all;
}

Planes Spread(Planes image) {
    return BoxSum(BoxSum(std::move(image), kSpreadRadius), kSpreadRadius);
}

struct Band {
    int y0, y1;
    ImageTile around;

    bool Has(size_t pixel, int width) const {
        const int y = int(pixel / size_t(width));
        return y >= y0 && y < y1;
    }
    bool Reaches(size_t pixel, int width) const {
        const int y = int(pixel / size_t(width));
        return y >= around.y0 && y < around.y1;
    }
    size_t Local(size_t pixel, int width) const {
        return pixel - size_t(around.y0) * size_t(width);
    }
};

template <typename Use>
void ForEachBand(const Planes& image, const Use& use) {
    for (int y0 = 0; y0 < image.height; y0 += kBandRows) {
        const int y1 = std::min(image.height, y0 + kBandRows);
        const ImageTile rows{0, y0 - kSpreadReach, image.width, y1 + kSpreadReach};
        use(Band{y0, y1, rows.Within(image.width, image.height)});
    }
}

// Returns what a pixel gets of fireflies in proportion to its brightness, up to white.
float ShareOf(const Planes& picture, size_t i) {
    return std::clamp(LuminanceOf(picture, i), 1e-4f, 1.f);
}

// Divides the energy of each firefly by the shares of the pixels around.
std::vector<Firefly> Divided(std::vector<Firefly> fireflies, const Planes& picture) {
    const int width = picture.width;
    ForEachBand(picture, [&](const Band& band) {
        const auto isOwn = [&](const Firefly& f) { return band.Has(f.pixel, width); };
        if (std::ranges::none_of(fireflies, isOwn)) return;
        const Planes rows = Crop(picture, band.around);
        Planes share(rows.width, rows.height, 1);
        for (size_t i = 0; i < share.Area(); ++i) share.values[i] = ShareOf(rows, i);
        const Planes around = Spread(std::move(share));
        for (Firefly& f : fireflies) {
            if (!isOwn(f)) continue;
            // More of one would not be given anyway, and its square would be beyond floats.
            constexpr float kMost = 1e9f;
            const Rgb whole = f.excess / around.values[band.Local(f.pixel, width)];
            f.excess = whole * std::min(1.f, kMost / std::max(Luminance(whole), 1.f));
        }
    });
    return fireflies;
}

}  // namespace

std::vector<Firefly> TakeFireflies(float limit, Halves* halves) {
    std::vector<Firefly> taken;
    for (int round = 0; round < kRounds; ++round)
        for (const auto& [half, pixel, scale] : Find(limit, *halves)) {
            Firefly firefly{pixel, {}};
            for (int c = 0; c < kColours; ++c) {
                float& value = (halves->*half).Plane(c)[pixel];
                const float less = value * scale;
                firefly.excess[c] = (value - less) / 2;  // of the mean of two
                value = less;
            }
            taken.push_back(firefly);
        }
    return taken;
}

Planes GiveBack(const std::vector<Firefly>& fireflies, Planes* picture) {
    const int width = picture->width;
    Planes deviation(width, picture->height, 1);
    if (fireflies.empty()) return deviation;
    const std::vector<Firefly> parts = Divided(fireflies, *picture);
    ForEachBand(*picture, [&](const Band& band) {
        // The energy of a pixel is divided among its neighbours in proportion to brightness. The
        // squares of its parts are at most these times the largest weight of the spread.
        constexpr float kLargestWeight = Sqr(2 * kSpreadRadius + 1.f);
        Planes given(width, band.around.y1 - band.around.y0, kColours);
        Planes squares(width, given.height, 1);
        bool isAny = false;
        for (const Firefly& f : parts) {
            if (!band.Reaches(f.pixel, width)) continue;
            const size_t i = band.Local(f.pixel, width);
            for (int c = 0; c < kColours; ++c) given.Plane(c)[i] += f.excess[c];
            squares.values[i] += Sqr(Luminance(f.excess));
            isAny = true;
        }
        if (!isAny) return;
        given = Spread(std::move(given));
        squares = Spread(std::move(squares));
        const size_t end = size_t(band.y1) * size_t(width);
        for (size_t i = size_t(band.y0) * size_t(width); i < end; ++i) {
            const size_t k = band.Local(i, width);
            const float y = LuminanceOf(given, k), variance = kLargestWeight * squares.values[k];
            if (!(y > 0) || !(variance > 0)) continue;
            const float share = ShareOf(*picture, i);
            const float count = Sqr(y) / variance;  // of fireflies, of equal size
            const float kept = std::min(1.f, kMostReturned * count / y) * share;
            for (int c = 0; c < kColours; ++c) picture->Plane(c)[i] += given.Plane(c)[k] * kept;
            deviation.values[i] = std::min(std::sqrt(variance) * share, LuminanceOf(*picture, i));
        }
    });
    return deviation;
}

namespace {

constexpr int kReachOfLeast = 2, kReachOfMost = 7;  // pixels

// Returns the extremes, by `pick`, of the pixels of a tile and those up to `reach` beside, above
// and below them. Beyond the border there is nothing.
template <typename Pick>
Planes Extremes(const Planes& image, const ImageTile& tile, int reach, const Pick& pick) {
    const int width = tile.x1 - tile.x0, height = tile.y1 - tile.y0;
    const int above = std::max(0, tile.y0 - reach), below = std::min(image.height, tile.y1 + reach);
    Planes rows(width, below - above, image.count), result(width, height, image.count);
    for (int c = 0; c < image.count; ++c) {
        for (int y = 0; y < rows.height; ++y) {
            const float* from = image.Row(c, above + y);
            float* to = rows.Row(c, y);
            std::copy_n(from + tile.x0, width, to);
            for (int d = -reach; d <= reach; ++d) {
                const int first = std::max(0, -tile.x0 - d);
                const int end = std::min(width, image.width - tile.x0 - d);
                for (int x = first; x < end; ++x) to[x] = pick(to[x], from[tile.x0 + x + d]);
            }
        }
        for (int y = 0; y < height; ++y) {
            float* to = result.Row(c, y);
            std::copy_n(rows.Row(c, tile.y0 + y - above), width, to);
            const int end = std::min(below, tile.y0 + y + reach + 1) - above;
            for (int v = std::max(above, tile.y0 + y - reach) - above; v < end; ++v)
                for (int x = 0; x < width; ++x) to[x] = pick(to[x], rows.Row(c, v)[x]);
        }
    }
    return result;
}

}  // namespace

void SampleRange::Clamp(Planes* picture) const {
    for (size_t i = 0; i < picture->values.size(); ++i)
        picture->values[i] =
            std::min(std::max(picture->values[i], least.values[i]), most.values[i]);
}

SampleRange RangeOfSamples(const Planes& noisy, const ImageTile& tile) {
    return {Extremes(noisy, tile, kReachOfLeast, [](float a, float b) { return std::min(a, b); }),
            Extremes(noisy, tile, kReachOfMost, [](float a, float b) { return std::max(a, b); })};
}

void ClampToSamples(const Planes& noisy, Planes* picture) {
    ForEachTile(noisy.width, noisy.height, [&](const ImageTile& tile) {
        Planes part = Crop(*picture, tile);
        RangeOfSamples(noisy, tile).Clamp(&part);
        Paste(part, {0, 0, part.width, part.height}, tile.x0, tile.y0, picture);
    });
}

}  // namespace lull
