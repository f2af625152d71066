#include "renderer/denoise/denoiser.h"

#include <cmath>

#include "stopping/signals/lightness.h"

namespace lull {

namespace {

constexpr int kTile = 16;
constexpr int kLeastTiles = 12;
constexpr double kLeastDetail = 1e-3;  // in lightness, of a tile in which there is anything to see
constexpr double kCommon = 9;          // times the variance that halves differ by
constexpr double kShare = 0.98;        // of the tiles
constexpr double kSpectrum = 0.08;     // by which correlations of noise of one spectrum may differ
constexpr double kOneSided = 0.15;     // of the variance that halves differ by
constexpr double kShareErrors = 3;     // standard errors

// White noise, filtered by HighPassed(), correlates so with the pixel beside.
constexpr double kWhite = -2.0 / 3;

// Above white too, as noise that is clipped there is none that can be compared.
Planes LightnessOf(const Planes& image) {
    Planes lightness(image.width, image.height, 1);
    for (size_t i = 0; i < lightness.Area(); ++i)
        lightness.values[i] = LightnessAt(Sane(LuminanceOf(image, i))).lightness;
    return lightness;
}

// Returns second differences along x and y, scaled to leave white noise as strong as it is; those
// of the border are 0. Gradients vanish.
Planes HighPassed(const Planes& image) {
    const int width = image.width, height = image.height;
    Planes result(width, height, 1);
    const auto along = [&](int x, int y) {
        const float* row = image.Row(0, y);
        return row[x - 1] - 2 * row[x] + row[x + 1];
    };
    for (int y = 1; y + 1 < height; ++y)
        for (int x = 1; x + 1 < width; ++x)
            result.Row(0, y)[x] = (along(x, y - 1) - 2 * along(x, y) + along(x, y + 1)) / 6;
    return result;
}

struct TileSums {
    double aa = 0, bb = 0, ab = 0, ad = 0;
    double abBeside = 0, ddBeside = 0;  // products with the pixels to the right and below

    double dd() const { return aa + bb - 2 * ab; }
    bool IsSeen() const { return (aa + bb) / 2 > kTile * kTile * kLeastDetail * kLeastDetail; }
};

TileSums SumTile(const Planes& a, const Planes& b, int x0, int y0) {
    TileSums sums;
    for (int y = y0; y < y0 + kTile; ++y)
        for (int x = x0; x < x0 + kTile; ++x) {
            const double u = double(a.Row(0, y)[x]), v = double(b.Row(0, y)[x]);
            sums.aa += u * u;
            sums.bb += v * v;
            sums.ab += u * v;
            sums.ad += u * (u - v);
            for (const auto& [dx, dy] : {std::pair(1, 0), {0, 1}}) {
                const double p = double(a.Row(0, y + dy)[x + dx]),
                             q = double(b.Row(0, y + dy)[x + dx]);
                sums.abBeside += (u * q + v * p) / 4;
                sums.ddBeside += (u - v) * (p - q) / 2;
            }
        }
    return sums;
}

struct Mean {
    double weights = 0, sum = 0, weightSquares = 0, weighted = 0, squares = 0;
    int count = 0;

    void Add(double x, double weight = 1) {
        weights += weight;
        sum += weight * x;
        weightSquares += weight * weight;
        weighted += weight * weight * x;
        squares += weight * weight * x * x;
        ++count;
    }
    double Value() const { return count ? sum / weights : 0; }
    double StandardError() const {
        const double m = Value(), sum2 = squares - 2 * m * weighted + m * m * weightSquares;
        return std::sqrt(std::max(0.0, sum2)) / weights;
    }
};

bool IsOneColour(const Planes& image) {
    for (int c = 0; c < kColours; ++c)
        for (size_t i = 0; i < image.Area(); ++i)
            if (image.Plane(c)[i] != image.Plane(c)[0]) return false;
    return true;
}

bool AreSame(const Planes& a, const Planes& b) {
    for (size_t i = 0; i < a.values.size(); ++i)
        if (Sane(a.values[i]) != Sane(b.values[i])) return false;
    return true;
}

}  // namespace

std::string DependenceOf(const Halves& halves) {
    if (AreSame(halves.a, halves.b))
        return IsOneColour(halves.a) ? ""
                                     : "both halves have the same colours, so that noise cannot be "
                                       "estimated; render one of them with another seed";
    const Planes a = HighPassed(LightnessOf(halves.a)), b = HighPassed(LightnessOf(halves.b));
    int seen = 0, common = 0;
    Mean ofCommon, ofDifference, shareOfA;
    for (int y = 1; y + kTile + 1 < a.height; y += kTile)
        for (int x = 1; x + kTile + 1 < a.width; x += kTile) {
            const TileSums tile = SumTile(a, b, x, y);
            if (!tile.IsSeen()) continue;
            ++seen;
            const double dd = std::max(tile.dd(), 0.0);
            if (tile.ab > kCommon * dd / 2) {
                ++common;
                ofCommon.Add(tile.abBeside / tile.ab);
            }
            if (dd < 1e-12 * (tile.aa + tile.bb)) continue;
            ofDifference.Add(tile.ddBeside / dd);
            // Of the noise, and by chance of the detail, which counts for less so.
            shareOfA.Add(tile.ad / dd, dd / (tile.aa + tile.bb));
        }
    if (seen < kLeastTiles) return "";
    const auto isLike = [&](double spectrum) {
        return std::abs(ofCommon.Value() - spectrum) < kSpectrum;
    };
    if (common >= kShare * seen &&
        (isLike(kWhite) || (ofDifference.count > 0 && isLike(ofDifference.Value()))))
        return "both halves have the same noise, and hardly differ otherwise; render one of "
               "them with another seed";
    if (shareOfA.count < kLeastTiles) return "";
    const double most = 1 - kOneSided + kShareErrors * shareOfA.StandardError();
    const bool isInA = shareOfA.Value() > most, isInB = 1 - shareOfA.Value() > most;
    if (isInA != isInB)
        return std::string("the noise by which the halves differ is all in ") +
               (isInA ? "the first" : "the second") +
               "; the other seems to contain its samples, or to have many more: halves are to have "
               "as many samples, and none in common";
    return "";
}

}  // namespace lull
