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

Halves CropHalves(const Halves& halves, const ImageTile& tile) {
    return {Crop(halves.a, tile), Crop(halves.b, tile)};
}

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
        const Halves noisy = CropHalves(level.noisy, crop);
        const Planes variance = Crop(level.variance, crop);
        std::vector<Halves> candidates;
        for (const Halves& picture : pictures)
            candidates.push_back(
                CropHalves(picture, {crop.x0, crop.y0 - first, crop.x1, crop.y1 - first}));
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

Halves FilterLevel(const Level& level) {
    const int width = level.Width(), height = level.Height();
    Halves result{Planes(width, height, kColours), Planes(width, height, kColours)};
    CandidateRows rows(width, std::min(height, BandRows(height) + 2 * kMargin));
    int done = 0;
    for (int y0 = 0; y0 < height; y0 += BandRows(height)) {
        const int y1 = std::min(height, y0 + BandRows(height));
        rows.Fit(level, y0, y1);
        const int ready = y1 == height ? height : y1 - kMargin;
        ForEachTile(width, done, ready, [&](const ImageTile& tile) {
            const ImageTile crop = tile.Grown(kMargin).Within(width, y1);
            const Halves chosen = rows.Choose(level, crop);
            const ImageTile part{tile.x0 - crop.x0, tile.y0 - crop.y0, tile.x1 - crop.x0,
                                 tile.y1 - crop.y0};
            Paste(chosen.a, part, tile.x0, tile.y0, &result.a);
            Paste(chosen.b, part, tile.x0, tile.y0, &result.b);
        });
        done = ready;
        rows.MoveTo(std::max(0, done - kMargin));
    }
    return result;
}

Halves FilterLevels(const Halves& noisy, const Planes& features, const Planes& variance, int scales,
                    int rowsPerFit) {
    Halves coarse;  // first, as nothing of this scale is there yet
    if (scales > 1 && std::min(variance.width, variance.height) >= 2 * kLeastSide) {
        Planes ofMeans = Halved(variance);
        for (float& v : ofMeans.values) v /= 4;
        coarse = FilterLevels({Halved(noisy.a), Halved(noisy.b)}, Halved(features), ofMeans,
                              scales - 1, rowsPerFit);
    }
    return FilterLevel({noisy, features, variance, coarse, rowsPerFit});
}

}  // namespace

Halves FilterColours(const Halves& noisy, const Planes& features, const Planes& variance,
                     int rowsPerFit) {
    return FilterLevels(noisy, features, variance, kScales, rowsPerFit);
}

}  // namespace lull
