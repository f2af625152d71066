
#include <array>
#include <bit>
#include <cmath>

#include "renderer/denoise/denoise.h"

namespace lull {

namespace {

constexpr PatchOptions kFeaturePatches{.radius = 5, .patchRadius = 3};
constexpr int kVarianceRadius = 1;
// Distance up to which pixels contribute to one.
constexpr int kReach = kFeaturePatches.radius + kFeaturePatches.patchRadius + kVarianceRadius;
constexpr float kLeastFeatureVariance = 1e-6f;  // below it noise is of no importance
constexpr int kBand = 64;                       // rows that are in memory at a time
constexpr int kDisparity = kFeatures - 1;

// Returns the median of one over the depth, where there is anything; 0 if there is nothing at all.
// A radix selection in two passes, as the values are too many to keep: positive floats are in the
// order of their bits, which are counted by the upper half, then by the lower.
float MedianDisparity(int height, const FeatureReader& read) {
    constexpr uint32_t kCounters = 1 << 16;
    std::vector<int64_t> high(kCounters), low(kCounters);
    const auto forEach = [&](const auto& use) {
        for (int y = 0; y < height; y += kBand) {
            const Halves halves = read(y, std::min(height, y + kBand));
            for (const Planes* half : {&halves.a, &halves.b})
                for (size_t i = 0; i < half->Area(); ++i)
                    if (const float d = Sane(half->Plane(kDisparity)[i]); d > 0)
                        use(std::bit_cast<uint32_t>(d));
        }
    };
    // Returns where the value number `rank` is, of which `rank` is made that within there.
    const auto find = [](const std::vector<int64_t>& counts, int64_t* rank) {
        uint32_t i = 0;
        for (; *rank >= counts[i]; ++i) *rank -= counts[i];
        return i;
    };
    int64_t count = 0;
    forEach([&](uint32_t bits) { ++high[bits / kCounters], ++count; });
    if (count == 0) return 0;
    int64_t rank = count / 2;
    const uint32_t middle = find(high, &rank);
    forEach([&](uint32_t bits) { low[bits % kCounters] += bits / kCounters == middle; });
    return std::bit_cast<float>(middle * kCounters + find(low, &rank));
}

// Brings features to [-1, 1]: one over the depth, d, becomes d / (d + median).
void ScaleFeatures(float median, Planes* half) {
    for (int f = 0; f < kDisparity; ++f)
        for (size_t i = 0; i < half->Area(); ++i) {
            float& v = half->Plane(f)[i];
            v = std::isfinite(v) ? std::clamp(v, -1.f, 1.f) : 0;
        }
    for (size_t i = 0; i < half->Area(); ++i) {
        float& d = half->Plane(kDisparity)[i];
        d = median > 0 ? Sane(d) / (Sane(d) + median) : 0;
    }
}

void AddFiltered(const Planes& image, const PatchGuide& guide, const ImageTile& tile,
                 Planes* result) {
    PatchWeights weights(guide, tile, 0, kFeaturePatches);
    const Cutout values(tile.Grown(kFeaturePatches.radius), image);
    std::vector<Lanes> sums(size_t(image.count));
    for (int y = tile.y0; y < tile.y1; ++y) {
        weights.MoveTo(y);
        for (int x = tile.x0; x < tile.x1; x += kLanes) {
            Lanes norm = Lanes::Zero();
            std::ranges::fill(sums, norm);
            for (int o = 0; o < int(weights.Offsets().size()); ++o) {
                const Lanes w = PatchWeights::WeightOf(weights.Distances(o, x), 1);
                const auto [dx, dy] = weights.Offsets()[size_t(o)];
                norm += w;
                for (int c = 0; c < image.count; ++c)
                    sums[size_t(c)] += w * LanesIn(values.At(c, x + dx, y + dy));
            }
            for (int c = 0; c < image.count; ++c) {
                const Lanes value = sums[size_t(c)] / norm * 0.5f;
                float* to = result->Row(c, y) + x;
                for (int i = 0; i < std::min(kLanes, tile.x1 - x); ++i) to[i] += value[i];
            }
        }
    }
}

}  // namespace

Planes FilterFeatures(int width, int height, const FeatureReader& read,
                      const std::function<void(int end)>& forget) {
    const float median = MedianDisparity(height, read);
    Planes result(width, height, kFeatures);
    for (int y0 = 0; y0 < height; y0 += kBand) {
        const int y1 = std::min(height, y0 + kBand);
        const int first = std::max(0, y0 - kReach), end = std::min(height, y1 + kReach);
        Halves halves = read(first, end);
        for (Planes* half : {&halves.a, &halves.b}) ScaleFeatures(median, half);
        Planes variance = BoxMean(VarianceOf(halves.a, halves.b), kVarianceRadius);
        for (float& v : variance.values) v += kLeastFeatureVariance;
        Planes filtered(width, end - first, kFeatures);
        ForEachTile(width, y0 - first, y1 - first, [&](const ImageTile& tile) {
            AddFiltered(halves.a, {halves.b, variance}, tile, &filtered);
            AddFiltered(halves.b, {halves.a, variance}, tile, &filtered);
        });
        Paste(filtered, {0, y0 - first, width, y1 - first}, 0, y0, &result);
        if (forget) forget(std::max(0, y1 - kReach));
    }
    return result;
}

namespace {

constexpr PatchOptions kPatches{.radius = 7, .patchRadius = 3};
constexpr std::array kBandwidths = {0.5f, 1.4f};
constexpr int kScales = 3;      // of which each has half the size of that before
constexpr int kLeastSide = 20;  // pixels of a picture that is looked at in half of its size
// Distance up to which pixels contribute to the choice of one, twice, with the coarse part in
// between: even, so that a crop is halved as the whole is.
constexpr int kMargin = 2 * kChoiceReach + 4;
static_assert(kMargin % 2 == 0);
constexpr int kFitReach = 2 * kPatches.radius;  // pixels from which a fit depends on features

bool HasCoarse(int width, int height) { return std::min(width, height) >= 2 * kLeastSide; }

// The share of the pixels of all scales that have been filtered.
class Meter {
  public:
    Meter(int width, int height, const ShareListener& onShare) : onShare(onShare) {
        for (int i = 0; i < kScales; ++i, width = (width + 1) / 2, height = (height + 1) / 2) {
            all += double(width) * height;
            if (!HasCoarse(width, height)) break;
        }
    }
    void Add(double pixels) {
        done += pixels;
        if (onShare) onShare(std::min(done / all, 1.0));
    }

  private:
    const ShareListener& onShare;
    double all = 0, done = 0;
};

struct Level {
    const Halves& noisy;
    const Planes& features;
    const Planes& variance;
    const Halves& coarse;  // the picture of the next, if there is one
    int rowsPerFit;

    int Width() const { return variance.width; }
    int Height() const { return variance.height; }
};

struct CandidateRows {
    int first = 0;  // the row of the picture that is their first
    std::vector<Halves> pictures;

    CandidateRows(int width, int rows) {
        const Planes picture(width, rows, kColours);
        pictures.assign(kBandwidths.size(), {picture, picture});
    }
    void MoveTo(int row) {
        for (Halves& picture : pictures)
            for (Planes* half : {&picture.a, &picture.b})
                for (int c = 0; c < kColours; ++c)
                    std::copy(half->Row(c, row - first), half->Row(c, 0) + half->Area(),
                              half->Row(c, 0));
        first = row;
    }
    void Fit(const Level& level, int y0, int y1) {
        ForEachTile(level.Width(), y0, y1, [&](const ImageTile& tile) {
            ForEachIndex(2, [&](int i) {
                const auto half = i == 0 ? &Halves::a : &Halves::b;
                const auto other = i == 0 ? &Halves::b : &Halves::a;
                const PatchGuide guide{level.noisy.*other, level.variance};
                std::vector<Planes> made = RegressTile({level.noisy.*half, level.features, guide,
                                                        kPatches, kBandwidths, level.rowsPerFit},
                                                       tile);
                const SampleRange range = RangeOfSamples(level.noisy.*half, tile);
                for (size_t b = 0; b < made.size(); ++b) {
                    range.Clamp(&made[b]);
                    Paste(made[b], {0, 0, made[b].width, made[b].height}, tile.x0, tile.y0 - first,
                          &(pictures[b].*half));
                }
            });
        });
    }
    Halves Choose(const Level& level, const ImageTile& crop) const {
        const Halves noisy = Crop(level.noisy, crop);
        const Planes variance = Crop(level.variance, crop);
        std::vector<Halves> candidates;
        for (const Halves& picture : pictures)
            candidates.push_back(
                Crop(picture, {crop.x0, crop.y0 - first, crop.x1, crop.y1 - first}));
        Halves fine = ChooseCandidates(std::move(candidates), noisy, variance);
        if (level.coarse.a.count == 0) return fine;
        const ImageTile half{crop.x0 / 2, crop.y0 / 2, (crop.x1 + 1) / 2, (crop.y1 + 1) / 2};
        Halves both{WithCoarsePart(fine.a, Crop(level.coarse.a, half)),
                    WithCoarsePart(fine.b, Crop(level.coarse.b, half))};
        RangeOfSamples(level.noisy.a, crop).Clamp(&both.a);
        RangeOfSamples(level.noisy.b, crop).Clamp(&both.b);
        candidates.clear();
        candidates.push_back(std::move(fine));
        candidates.push_back(std::move(both));
        return ChooseCandidates(std::move(candidates), noisy, variance);
    }
};

// Frees the features, which are large, as far as they are of no use any more.
Halves FilterLevel(const Level& level, Planes* features, Meter* meter) {
    const int width = level.Width(), height = level.Height();
    Halves result{Planes(width, height, kColours), Planes(width, height, kColours)};
    CandidateRows rows(width, std::min(height, BandRows(height) + 2 * kMargin));
    int done = 0, forgotten = 0;
    for (int y0 = 0; y0 < height; y0 += BandRows(height)) {
        const int y1 = std::min(height, y0 + BandRows(height));
        rows.Fit(level, y0, y1);
        features->ForgetRows(forgotten, std::max(forgotten, y1 - kFitReach));
        forgotten = std::max(forgotten, y1 - kFitReach);
        const int ready = y1 == height ? height : y1 - kMargin;
        ForEachTile(width, done, ready, [&](const ImageTile& tile) {
            const ImageTile crop = tile.Grown(kMargin).Within(width, y1);
            const Halves chosen = rows.Choose(level, crop);
            const ImageTile part = tile.In(crop);
            Paste(chosen.a, part, tile.x0, tile.y0, &result.a);
            Paste(chosen.b, part, tile.x0, tile.y0, &result.b);
        });
        done = ready;
        meter->Add(double(width) * (y1 - y0));
        rows.MoveTo(std::max(0, done - kMargin));
    }
    return result;
}

// Filters a picture and, unless it is too small for that or no scale is left, the same at half of
// its size, and at less: first, as nothing of this scale is there yet.
Halves FilterLevels(const Halves& noisy, Planes features, const Planes& variance, int scales,
                    int rowsPerFit, Meter* meter) {
    Halves coarse;
    if (scales > 1 && HasCoarse(variance.width, variance.height)) {
        Planes ofMeans = Halved(variance);
        for (float& v : ofMeans.values) v /= 4;
        coarse = FilterLevels({Halved(noisy.a), Halved(noisy.b)}, Halved(features), ofMeans,
                              scales - 1, rowsPerFit, meter);
    }
    return FilterLevel({noisy, features, variance, coarse, rowsPerFit}, &features, meter);
}

}  // namespace

Halves FilterColours(const Halves& noisy, Planes features, const Planes& variance, Effort effort,
                     const ShareListener& onShare) {
    const int rowsPerFit = effort == Effort::Full ? 1 : 2;
    Meter meter(variance.width, variance.height, onShare);
    return FilterLevels(noisy, std::move(features), variance, kScales, rowsPerFit, &meter);
}

}  // namespace lull
