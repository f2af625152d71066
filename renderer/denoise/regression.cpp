#include "renderer/denoise/denoise.h"

#include <array>
#include <cmath>
#include <utility>

namespace lull {

namespace {

// The unknowns of a fit: a constant, a slope for each feature, and for x and y.
constexpr int kUnknowns = 1 + kFeatures + 2;
constexpr int kSlopeX = kUnknowns - 2, kSlopeY = kUnknowns - 1;
constexpr int kColumns = kUnknowns + kColours;
// Features whose variance in a window is below this say nothing of its colours.
constexpr float kRidge = 1e-4f;
// Neighbours of less weight are left out where that is so of all sixteen.
constexpr float kLeastWeight = 1e-3f;
constexpr float kFarthest =
    7;  // squared bandwidths: a neighbour has less than that weight for sure
constexpr float kOwnWeight = 0.1f;  // of a pixel's own colour, where there is no fit around it
constexpr int kAtOnce = 4;          // neighbours for which each sum is loaded and stored once

static_assert(kUnknowns % 2 == 0);

// The normal equations, one a row: sums of w xi xj from the diagonal on, then of w xi c.
using Equations = std::array<std::array<Lanes, kColumns>, kUnknowns>;

// Adds neighbours with these weights to the rows i and i + 1, which have their values loaded once;
// values are xj and c of each. Columns are written out: loops of few rounds cost more.
template <size_t i, size_t... j>
void AddToRows(const Lanes* weights, const std::array<Lanes, kColumns>* values,
               std::index_sequence<j...>, Equations* equations) {
    Lanes first[kAtOnce], second[kAtOnce];
    for (size_t k = 0; k < kAtOnce; ++k) {
        first[k] = weights[k] * values[k][i];
        second[k] = weights[k] * values[k][i + 1];
    }
    const auto addTo = [&](size_t column) {
        Lanes a = (*equations)[i][column], b = (*equations)[i + 1][column];
        for (size_t k = 0; k < kAtOnce; ++k) {
            a += first[k] * values[k][column];
            b += second[k] * values[k][column];
        }
        (*equations)[i][column] = a;
        (*equations)[i + 1][column] = b;
    };
    (addTo(i + j), ...);
}

template <size_t... pair>
void AddNeighbours(const Lanes* weights, const std::array<Lanes, kColumns>* values,
                   std::index_sequence<pair...>, Equations* equations) {
    (AddToRows<2 * pair>(weights, values, std::make_index_sequence<kColumns - 2 * pair>(),
                         equations),
     ...);
}

// Solves them by Cholesky decomposition (L D L'): the columns of colours become the unknowns.
void Solve(Equations* equations) {
    Equations& e = *equations;
    const Lanes ridge = e[0][0] * kRidge;
    for (size_t i = 1; i < kUnknowns; ++i) e[i][i] += ridge;
    std::array<Lanes, kUnknowns> inverse;
    for (size_t i = 0; i < kUnknowns; ++i) {
        inverse[i] = e[i][i].max(ridge * 0.1f + 1e-30f).inverse();
        for (size_t j = i + 1; j < kUnknowns; ++j) {
            const Lanes factor = e[i][j] * inverse[i];
            for (size_t k = j; k < kColumns; ++k) e[j][k] -= factor * e[i][k];
        }
    }
    for (size_t i = kUnknowns; i-- > 0;)
        for (size_t c = kUnknowns; c < kColumns; ++c) {
            Lanes sum = e[i][c];
            for (size_t j = i + 1; j < kUnknowns; ++j) sum -= e[i][j] * e[j][c];
            e[i][c] = sum * inverse[i];
        }
}

struct Neighbour {
    int x, y;            // relative to the pixel
    ptrdiff_t distance;  // in memory
};

float Largest(const Lanes& values) {
    const auto of8 = values.head<8>().max(values.tail<8>()).eval();
    const auto of4 = of8.head<4>().max(of8.tail<4>()).eval();
    return std::max(std::max(of4[0], of4[1]), std::max(of4[2], of4[3]));
}

float Least(const Lanes& values) { return -Largest(-values); }

// Fits sixteen pixels at a time, and adds each fit to the pixels that it was made from.
class TileFits {
  public:
    TileFits(const RegressionInput& in, const ImageTile& tile)
        : in(in),
          tile(tile),
          radius(in.patches.radius),
          scale(1 / float(radius)),
          colour(tile.Grown(2 * radius), in.colour),
          features(tile.Grown(2 * radius), in.features),
          weights(in.guide, tile, radius, in.patches),
          distances(weights.Offsets().size()),
          neighbours(distances.size() + kAtOnce),
          weightsOf(neighbours.size()) {
        const ImageTile wide{tile.x0 - 2 * radius, tile.y0, tile.x1 + 2 * radius, tile.y1};
        sums.assign(in.bandwidths.size(), Cutout(wide, kColours + 1));
        for (int y = tile.y0; y < tile.y1; ++y)
            if (!HasFits(y)) AddOwnColours(y);
        const int end = std::min(tile.y1 + radius, in.colour.height);
        for (int y = std::max(tile.y0 - radius, 0); y < end; ++y) {
            if (!HasFits(y)) continue;
            weights.MoveTo(y);
            for (int x = tile.x0 - radius; x < tile.x1 + radius; x += kLanes) FitAll(x, y);
        }
    }

    Planes Result(size_t bandwidth) const {
        Planes result(tile.x1 - tile.x0, tile.y1 - tile.y0, kColours);
        const Cutout& from = sums[bandwidth];
        for (int c = 0; c < kColours; ++c)
            for (int y = tile.y0; y < tile.y1; ++y) {
                const float *sum = from.At(c, tile.x0, y), *norm = from.At(kColours, tile.x0, y);
                float* to = result.Row(c, y - tile.y0);
                for (int x = 0; x < result.width; ++x) to[x] = sum[x] / (norm[x] + 1e-30f);
            }
        return result;
    }

  private:
    bool HasFits(int y) const { return y % in.rowsPerFit == 0; }

    // A pixel without a fit, which may be like none around, has its own colour too.
    void AddOwnColours(int y) {
        for (Cutout& to : sums)
            for (int x = tile.x0; x < tile.x1; ++x) {
                for (int c = 0; c < kColours; ++c)
                    *to.At(c, x, y) = *colour.At(c, x, y) * kOwnWeight;
                *to.At(kColours, x, y) = kOwnWeight;
            }
    }

    void FitAll(int x, int y) {
        for (size_t o = 0; o < distances.size(); ++o) distances[o] = weights.Distances(int(o), x);
        for (size_t b = 0; b < in.bandwidths.size(); ++b) Fit(x, y, b);
    }

    void Fit(int x, int y, size_t bandwidth) {
        FindNeighbours(in.bandwidths[bandwidth]);
        const float *featuresHere = features.At(0, x, y), *coloursHere = colour.At(0, x, y);
        for (size_t f = 0; f < kFeatures; ++f)
            centre[f] = LanesIn(featuresHere + f * features.PlaneSize());
        for (auto& equation : equations) equation.fill(Lanes::Zero());
        std::array<Lanes, kColumns> values[kAtOnce];
        for (size_t n = 0; n < count; n += kAtOnce) {
            for (size_t k = 0; k < kAtOnce; ++k)
                Look(neighbours[n + k], featuresHere, coloursHere, &values[k]);
            AddNeighbours(&weightsOf[n], values, std::make_index_sequence<kUnknowns / 2>(),
                          &equations);
        }
        Solve(&equations);
        Spread(x, y, &sums[bandwidth]);
    }

    // Finds those whose weights matter, column by column: so Spread() does not load values just
    // stored at another place, which would stall the processor.
    void FindNeighbours(float bandwidth) {
        count = 0;
        const int side = 2 * radius + 1;
        const float farthest = kFarthest * bandwidth * bandwidth;
        for (int dx = -radius; dx <= radius; ++dx)
            for (int dy = -radius; dy <= radius; ++dy) {
                const Lanes& d = distances[size_t((dy + radius) * side + dx + radius)];
                if (Least(d) > farthest) continue;
                const Lanes w = PatchWeights::WeightOf(d, bandwidth);
                if (!(Largest(w) > kLeastWeight)) continue;
                neighbours[count] = {dx, dy, dy * features.Stride() + dx};
                weightsOf[count++] = w;
            }
        for (size_t k = count; k < count + kAtOnce; ++k) {
            neighbours[k] = {0, 0, 0};
            weightsOf[k] = Lanes::Zero();
        }
    }

    void Look(const Neighbour& at, const float* featuresHere, const float* coloursHere,
              std::array<Lanes, kColumns>* values) const {
        (*values)[0] = Lanes::Ones();
        for (size_t f = 0; f < kFeatures; ++f)
            (*values)[1 + f] =
                LanesIn(featuresHere + f * features.PlaneSize() + at.distance) - centre[f];
        (*values)[kSlopeX] = Lanes::Constant(float(at.x) * scale);
        (*values)[kSlopeY] = Lanes::Constant(float(at.y) * scale);
        for (size_t c = 0; c < kColours; ++c)
            (*values)[kUnknowns + c] = LanesIn(coloursHere + c * colour.PlaneSize() + at.distance);
    }

    // Adds the fit's prediction at (x, y) for its neighbours by their weights, the same both ways.
    void Spread(int x, int y, Cutout* to) {
        const auto unknown = [&](size_t i, size_t c) -> Lanes& {
            return equations[i][kUnknowns + c];
        };
        for (size_t c = 0; c < kColours; ++c)  // the constant becomes that where features are 0
            for (size_t f = 0; f < kFeatures; ++f) unknown(0, c) -= unknown(1 + f, c) * centre[f];
        Lanes isInside;
        for (int i = 0; i < kLanes; ++i) isInside[i] = x + i >= 0 && x + i < in.colour.width;
        const size_t featurePlane = features.PlaneSize(), sumPlane = to->PlaneSize();
        for (size_t n = 0; n < count; ++n) {
            const Neighbour& at = neighbours[n];
            if (y + at.y < tile.y0 || y + at.y >= tile.y1) continue;
            const Lanes w = weightsOf[n] * isInside;
            const float* feature = features.At(0, x, y) + at.distance;
            float* sum = to->At(0, x + at.x, y + at.y);
            std::array<Lanes, kColours> value;
            for (size_t c = 0; c < kColours; ++c)
                value[c] = unknown(0, c) + unknown(kSlopeX, c) * (float(at.x) * scale) +
                           unknown(kSlopeY, c) * (float(at.y) * scale);
            for (size_t f = 0; f < kFeatures; ++f) {
                const LanesIn v(feature + f * featurePlane);
                for (size_t c = 0; c < kColours; ++c) value[c] += unknown(1 + f, c) * v;
            }
            for (size_t c = 0; c < kColours; ++c, sum += sumPlane)
                Store(LanesIn(sum) + w * value[c], sum);
            Store(LanesIn(sum) + w, sum);
        }
    }

    const RegressionInput& in;
    ImageTile tile;
    int radius;
    float scale;  // pixels to the units of the slopes along x and y
    Cutout colour, features;
    PatchWeights weights;
    std::vector<Cutout> sums;      // for each bandwidth: R, G, B and 1, times weights
    std::vector<Lanes> distances;  // of the pixels at hand, by offset
    // Of the fit at hand:
    size_t count = 0;
    std::vector<Neighbour> neighbours;
    std::vector<Lanes> weightsOf;  // these
    std::array<Lanes, kFeatures> centre;
    Equations equations;
};

}  // namespace

std::vector<Planes> RegressTile(const RegressionInput& in, const ImageTile& tile) {
    const TileFits fits(in, tile);
    std::vector<Planes> results;
    for (size_t b = 0; b < in.bandwidths.size(); ++b) results.push_back(fits.Result(b));
    return results;
}

namespace {

constexpr int kErrorRadius = 5, kChoiceRadius = 6;  // pixels over which both are smoothed
static_assert(kErrorRadius + kChoiceRadius == kChoiceReach);
constexpr float kDarkest = 1e-3f;  // squared luminance below which errors are no longer relative
constexpr float kAlikeVariance = 1e-4f;  // relative, squared; below it, pixels count alike
constexpr float kChanceDeviations = 2;   // of chance that a candidate must be better by

struct ErrorScale {
    Planes ofSquares;  // makes squared errors relative
    Planes weight;     // of pixels
    Planes weights;    // its sum around
};

Planes SumAround(Planes image) { return BoxSum(std::move(image), kErrorRadius); }

float SumOfColours(const Planes& image, size_t i) {
    return image.Plane(0)[i] + image.Plane(1)[i] + image.Plane(2)[i];
}

ErrorScale MakeErrorScale(const Halves& smooth, const Planes& variance) {
    ErrorScale scale{Planes(variance.width, variance.height, 1), {}, {}};
    scale.weight = scale.ofSquares;
    for (size_t i = 0; i < scale.ofSquares.Area(); ++i) {
        const float y = (LuminanceOf(smooth.a, i) + LuminanceOf(smooth.b, i)) / 2;
        scale.ofSquares.values[i] = 1 / (kDarkest + y * y);
        const float noise = SumOfColours(variance, i) * scale.ofSquares.values[i];
        scale.weight.values[i] = 1 / (noise * noise + kAlikeVariance);
    }
    scale.weights = SumAround(scale.weight);
    return scale;
}

// Estimates the squared error of the mean of both halves by that of `made`, of which `other` is the
// other half, against `reference`, whose noise squared is estimated by `noise`.
Planes ErrorOf(const Planes& made, const Planes& other, const Planes& reference,
               const Planes& noise, const ErrorScale& scale) {
    const auto square = [](float x) { return x * x; };
    Planes error(made.width, made.height, 1);
    for (size_t i = 0; i < error.Area(); ++i) {
        float sum = 0;
        for (int c = 0; c < kColours; ++c) {
            const float x = made.Plane(c)[i];
            sum += square(x - reference.Plane(c)[i]) - noise.Plane(c)[i] -
                   square(x - other.Plane(c)[i]) / 4;
        }
        error.values[i] = sum * scale.ofSquares.values[i] * scale.weight.values[i];
    }
    error = SumAround(std::move(error));
    for (size_t i = 0; i < error.Area(); ++i) error.values[i] /= scale.weights.values[i];
    return error;
}

// Returns the squared error of the samples: their variance, and the others' chance error.
Planes ErrorOfNoise(const Planes& variance, const ErrorScale& scale) {
    Planes error(variance.width, variance.height, 1), chance = error;
    for (size_t i = 0; i < error.Area(); ++i) {
        const float noise = SumOfColours(variance, i) * scale.ofSquares.values[i];
        const float weighted = noise * scale.weight.values[i];
        error.values[i] = noise / 2;
        chance.values[i] = weighted * weighted / 2;
    }
    error = BoxMean(std::move(error), kErrorRadius);
    chance = SumAround(std::move(chance));
    for (size_t i = 0; i < error.Area(); ++i)
        error.values[i] +=
            kChanceDeviations * std::sqrt(chance.values[i]) / scale.weights.values[i];
    return error;
}

// Returns, for each of several images, 1 at the pixels where it has the least value, smoothed.
std::vector<Planes> SharesOfLeast(const std::vector<Planes>& images) {
    std::vector<Planes> shares(images.size(), Planes(images[0].width, images[0].height, 1));
    for (size_t i = 0; i < images[0].Area(); ++i) {
        size_t least = 0;
        for (size_t k = 1; k < images.size(); ++k)
            if (images[k].values[i] < images[least].values[i]) least = k;
        shares[least].values[i] = 1;
    }
    for (Planes& share : shares) share = BoxMean(std::move(share), kChoiceRadius);
    return shares;
}

}  // namespace

Halves ChooseCandidates(std::vector<Halves> candidates, const Halves& noisy,
                        const Planes& variance) {
    const ErrorScale scale = MakeErrorScale(candidates.back(), variance);
    const Planes noise = VarianceOf(noisy.a, noisy.b), ofSamples = ErrorOfNoise(variance, scale);
    const auto mix = [&](Planes Halves::*half, Planes Halves::*other) {
        std::vector<Planes> errors;
        for (const Halves& c : candidates)
            errors.push_back(ErrorOf(c.*other, c.*half, noisy.*half, noise, scale));
        errors.push_back(ofSamples);
        const std::vector<Planes> shares = SharesOfLeast(errors);
        Planes result(variance.width, variance.height, kColours);
        for (size_t k = 0; k < shares.size(); ++k) {
            const Planes& from = k < candidates.size() ? candidates[k].*half : noisy.*half;
            for (int c = 0; c < kColours; ++c)
                for (size_t i = 0; i < result.Area(); ++i)
                    result.Plane(c)[i] += from.Plane(c)[i] * shares[k].values[i];
        }
        return result;
    };
    return {mix(&Halves::a, &Halves::b), mix(&Halves::b, &Halves::a)};
}

}  // namespace lull
