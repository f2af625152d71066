#include "renderer/denoise/filter_colours.h"

#include <array>

#include "renderer/denoise/candidates.h"
#include "renderer/denoise/regression.h"
#include "renderer/denoise/sample_range.h"
#include "renderer/denoise/scales.h"

namespace lull {

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

// Returns whether a picture is large enough to be looked at in half of its size.
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

// Inputs of one scale.
struct Level {
    const Halves& noisy;
    const Planes& features;
    const Planes& variance;
    const Halves& coarse;  // the picture of the next, if there is one
    int rowsPerFit;

    int Width() const { return variance.width; }
    int Height() const { return variance.height; }
};

// Some rows of the candidates of all bandwidths.
struct CandidateRows {
    int first = 0;  // the row of the picture that is their first
    std::vector<Halves> pictures;

    CandidateRows(int width, int rows) {
        const Planes picture(width, rows, kColours);
        pictures.assign(kBandwidths.size(), {picture, picture});
    }
    // Forgets the rows above `row`.
    void MoveTo(int row) {
        for (Halves& picture : pictures)
            for (Planes* half : {&picture.a, &picture.b})
                for (int c = 0; c < kColours; ++c)
                    std::copy(half->Row(c, row - first), half->Row(c, 0) + half->Area(),
                              half->Row(c, 0));
        first = row;
    }
    // Makes the rows [y0, y1).
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
    // Returns a crop, which begins at an even pixel, of the best of all scales.
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

Halves FilterLevels(const Halves& noisy, Planes features, const Planes& variance, int scales,
                    int rowsPerFit, Meter* meter);

// Filters a picture at half of its size, and at less. Returns nothing where it is too small for
// that, or where no scale is left.
Halves FilterCoarse(const Halves& noisy, const Planes& features, const Planes& variance, int scales,
                    int rowsPerFit, Meter* meter) {
    if (scales == 0 || !HasCoarse(variance.width, variance.height)) return {};
    Planes ofMeans = Halved(variance);
    for (float& v : ofMeans.values) v /= 4;
    return FilterLevels({Halved(noisy.a), Halved(noisy.b)}, Halved(features), ofMeans, scales,
                        rowsPerFit, meter);
}

Halves FilterLevels(const Halves& noisy, Planes features, const Planes& variance, int scales,
                    int rowsPerFit, Meter* meter) {
    // First, as nothing of this scale is there yet.
    const Halves coarse = FilterCoarse(noisy, features, variance, scales - 1, rowsPerFit, meter);
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
