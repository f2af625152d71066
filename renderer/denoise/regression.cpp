#include "renderer/denoise/regression.h"

#include <array>

namespace lull {

namespace {

// The unknowns of a fit: a constant, a slope for each feature, and for x and y.
constexpr int kUnknowns = 1 + kFeatures + 2;
constexpr int kSlopeX = kUnknowns - 2, kSlopeY = kUnknowns - 1;
constexpr int kMoments = kUnknowns * (kUnknowns + 1) / 2;
// Features whose variance in a window is below this say nothing of its colours.
constexpr float kRidge = 1e-4f;
// Neighbours of less weight are left out where that is so of all sixteen.
constexpr float kLeastWeight = 1e-3f;
constexpr float kOwnWeight = 0.1f;  // of a pixel's own colour, where there is no fit around it

using Moments = std::array<Lanes, kMoments>;               // w xi xj for j >= i, row by row
using Products = std::array<Lanes, kUnknowns * kColours>;  // w xi c

// Solves the normal equations by Cholesky decomposition (L D L'): the products become the unknowns.
void Solve(Moments* moments, Products* products) {
    const auto at = [&](size_t i, size_t j) -> Lanes& {  // j >= i
        return (*moments)[i * kUnknowns - i * (i + 1) / 2 + j];
    };
    const Lanes ridge = at(0, 0) * kRidge;
    for (size_t i = 1; i < kUnknowns; ++i) at(i, i) += ridge;
    std::array<Lanes, kUnknowns> inverse;
    for (size_t i = 0; i < kUnknowns; ++i) {
        inverse[i] = at(i, i).max(ridge * 0.1f + 1e-30f).inverse();
        for (size_t j = i + 1; j < kUnknowns; ++j) {
            const Lanes factor = at(i, j) * inverse[i];
            for (size_t k = j; k < kUnknowns; ++k) at(j, k) -= factor * at(i, k);
            for (size_t c = 0; c < kColours; ++c)
                (*products)[j * kColours + c] -= factor * (*products)[i * kColours + c];
        }
    }
    for (size_t i = kUnknowns; i-- > 0;)
        for (size_t c = 0; c < kColours; ++c) {
            Lanes sum = (*products)[i * kColours + c];
            for (size_t j = i + 1; j < kUnknowns; ++j)
                sum -= at(i, j) * (*products)[j * kColours + c];
            (*products)[i * kColours + c] = sum * inverse[i];
        }
}

// Holds the fits of a tile, and of the pixels around it that its own pixels were used for.
class TileFits {
  public:
    TileFits(const Cutout& colour, const Cutout& features, const PatchWeights& weights,
             const ImageTile& tile, int radius, float bandwidth, int rowsPerFit)
        : colour(colour),
          features(features),
          weights(weights),
          bandwidth(bandwidth),
          rowsPerFit(rowsPerFit),
          scale(1 / float(radius)),
          fits(tile.Grown(radius), kUnknowns * kColours) {
        const ImageTile& area = fits.Area();
        for (int y = area.y0; y < area.y1; ++y)
            if (HasFits(y))
                for (int x = area.x0; x < area.x1; x += kLanes) Fit(x, y);
    }

    // Returns what the fits around say of the pixels (x, y) to (x + 15, y), by their weights.
    std::array<Lanes, kColours> Gather(int x, int y) const {
        std::array<Lanes, kColours> sums;
        sums.fill(Lanes::Zero());
        Lanes norm = Lanes::Constant(1e-30f);
        if (!HasFits(y)) {
            norm = Lanes::Constant(kOwnWeight);
            for (int c = 0; c < kColours; ++c)
                sums[size_t(c)] = LanesIn(colour.At(c, x, y)) * kOwnWeight;
        }
        for (int o = 0; o < int(weights.Offsets().size()); ++o) {
            const PatchWeights::Offset at = weights.Offsets()[size_t(o)];
            if (!HasFits(y + at.y)) continue;
            const Lanes w = weights.Of(o, x, y, bandwidth);
            if (!(w.maxCoeff() > kLeastWeight)) continue;
            norm += w;
            for (int c = 0; c < kColours; ++c) {
                const auto unknown = [&](int i) {
                    return LanesIn(fits.At(i * kColours + c, x + at.x, y + at.y));
                };
                Lanes value = unknown(0);
                for (int f = 0; f < kFeatures; ++f)
                    value += unknown(1 + f) * LanesIn(features.At(f, x, y));
                value -= unknown(kSlopeX) * (float(at.x) * scale);
                value -= unknown(kSlopeY) * (float(at.y) * scale);
                sums[size_t(c)] += w * value;
            }
        }
        for (Lanes& sum : sums) sum /= norm;
        return sums;
    }

  private:
    // A pixel without a fit, which may be like none around, has its own colour instead.
    bool HasFits(int y) const { return y % rowsPerFit == 0; }

    void Fit(int x, int y) {
        Moments moments;
        Products products;
        moments.fill(Lanes::Zero());
        products.fill(Lanes::Zero());
        for (int o = 0; o < int(weights.Offsets().size()); ++o) {
            const Lanes w = weights.Of(o, x, y, bandwidth);
            if (!(w.maxCoeff() > kLeastWeight)) continue;
            const auto [dx, dy] = weights.Offsets()[size_t(o)];
            std::array<Lanes, kUnknowns> at;
            at[0] = Lanes::Ones();
            for (int f = 0; f < kFeatures; ++f)
                at[size_t(1 + f)] =
                    LanesIn(features.At(f, x + dx, y + dy)) - LanesIn(features.At(f, x, y));
            at[kSlopeX] = Lanes::Constant(float(dx) * scale);
            at[kSlopeY] = Lanes::Constant(float(dy) * scale);
            size_t m = 0;
            for (size_t i = 0; i < kUnknowns; ++i) {
                const Lanes wx = w * at[i];
                for (size_t j = i; j < kUnknowns; ++j) moments[m++] += wx * at[j];
                for (size_t c = 0; c < kColours; ++c)
                    products[i * kColours + c] += wx * LanesIn(colour.At(int(c), x + dx, y + dy));
            }
        }
        Solve(&moments, &products);
        // Features were taken relative to the centre; the constant becomes that where they are 0.
        for (size_t c = 0; c < kColours; ++c)
            for (size_t f = 0; f < kFeatures; ++f)
                products[c] -=
                    products[(1 + f) * kColours + c] * LanesIn(features.At(int(f), x, y));
        for (size_t i = 0; i < products.size(); ++i) Store(products[i], fits.At(int(i), x, y));
    }

    const Cutout& colour;
    const Cutout& features;
    const PatchWeights& weights;
    float bandwidth;
    int rowsPerFit;
    float scale;  // pixels to what the slopes along x and y are of
    Cutout fits;
};

}  // namespace

std::vector<Planes> Regress(const Planes& colour, const Planes& features, const PatchGuide& guide,
                            const PatchOptions& options, std::span<const float> bandwidths,
                            int rowsPerFit) {
    std::vector<Planes> pictures(bandwidths.size(), Planes(colour.width, colour.height, kColours));
    ForEachTile(colour.width, colour.height, [&](const ImageTile& tile) {
        const ImageTile around = tile.Grown(2 * options.radius);
        const Cutout colours(around, colour), values(around, features);
        const PatchWeights weights(guide, tile, options.radius, options);
        for (size_t b = 0; b < bandwidths.size(); ++b) {
            const TileFits fits(colours, values, weights, tile, options.radius, bandwidths[b],
                                rowsPerFit);
            for (int y = tile.y0; y < tile.y1; ++y)
                for (int x = tile.x0; x < tile.x1; x += kLanes) {
                    const std::array<Lanes, kColours> result = fits.Gather(x, y);
                    for (int c = 0; c < kColours; ++c)
                        std::copy_n(result[size_t(c)].data(), std::min(kLanes, tile.x1 - x),
                                    pictures[b].Row(c, y) + x);
                }
        }
    });
    return pictures;
}

}  // namespace lull
