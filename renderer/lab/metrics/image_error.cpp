#include "renderer/lab/metrics/image_error.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "renderer/base/error.h"
#include "renderer/base/math.h"
#include "renderer/vision/visible_difference.h"
#include "stopping/signals/lightness.h"

namespace lull {

namespace {

double Finite(float v) { return std::isfinite(v) ? double(v) : 0; }

void AddLinearErrors(const RgbImage& image, const RgbImage& reference, ErrorMaps* maps) {
    for (size_t i = 0; i < image.values.size(); i += 3) {
        double squared = 0, relative = 0;
        for (size_t c = i; c < i + 3; ++c) {
            const double r = Finite(reference.values[c]);
            const double e = Sqr(Finite(image.values[c]) - r);
            squared += e / 3;
            relative += e / (3 * (r * r + 0.01));
        }
        maps->squared.push_back(float(squared));
        maps->relative.push_back(float(relative));
    }
}

// Returns the means over a rectangle of values that are not NaN, NaN where there are none.
double MeanOf(const std::vector<float>& map, int width, const PixelRect& rect) {
    double sum = 0;
    int64_t count = 0;
    for (int y = rect.min.y(); y < rect.max.y(); ++y)
        for (int x = rect.min.x(); x < rect.max.x(); ++x) {
            const float v = map[size_t(y) * width + x];
            if (std::isnan(v)) continue;
            sum += double(v);
            ++count;
        }
    return count > 0 ? sum / double(count) : std::numeric_limits<double>::quiet_NaN();
}

std::vector<float> LinearValues(std::span<const uint8_t> srgb) {
    const std::array<double, 256>& linear = DecodeSrgb8();
    std::vector<float> values;
    values.reserve(srgb.size());
    for (const uint8_t v : srgb) values.push_back(float(linear[v]));
    return values;
}

}  // namespace

ErrorMaps CompareImages(const RgbImage& image, const RgbImage& reference,
                        const DisplayModel& display) {
    if (image.width != reference.width || image.height != reference.height)
        throw Error("an image of {}x{} pixels cannot be compared with one of {}x{}", image.width,
                    image.height, reference.width, reference.height);
    ErrorMaps maps;
    maps.width = image.width;
    maps.height = image.height;
    AddLinearErrors(image, reference, &maps);

    const size_t pixels = image.values.size() / 3;
    std::vector<uint8_t> a(3 * pixels), b(3 * pixels);
    EncodeSrgb8(image.values, a);
    EncodeSrgb8(reference.values, b);
    std::vector<double> lightnessA(pixels), lightnessB(pixels);
    Lightness(a, lightnessA);
    Lightness(b, lightnessB);
    for (size_t i = 0; i < pixels; ++i) {
        maps.lightness.push_back(float(Sqr(lightnessA[i] - lightnessB[i])));
        double squared = 0;
        for (size_t c = 3 * i; c < 3 * i + 3; ++c) squared += Sqr(double(a[c]) - double(b[c])) / 3;
        maps.display.push_back(float(squared));
    }
    maps.ssim = SsimMap(a, b, image.width, image.height);
    maps.flip = FlipMap(a, b, image.width, image.height, DefaultPixelsPerDegree());
    maps.visibleDifference =
        FindVisibleDifference(LinearValues(a), LinearValues(b), image.width, image.height, display);
    return maps;
}

ErrorFigures Average(const ErrorMaps& maps, const PixelRect& rect) {
    const auto mean = [&](const std::vector<float>& map) { return MeanOf(map, maps.width, rect); };
    return {.rmse = std::sqrt(mean(maps.squared)),
            .relMse = mean(maps.relative),
            .rmseLightness = std::sqrt(mean(maps.lightness)),
            .psnr = 10 * std::log10(Sqr(255.0) / mean(maps.display)),
            .ssim = mean(maps.ssim),
            .flip = mean(maps.flip),
            .visibleDifference = PooledDifference(maps.visibleDifference, rect)};
}

ErrorFigures Average(const ErrorMaps& maps) {
    return Average(maps, {{0, 0}, {maps.width, maps.height}});
}

namespace {

constexpr int kDepth = 10, kLength = 20;

double RootMeanSquare(std::span<const float> noise, int width, const PixelRect& rect) {
    double sum = 0;
    for (int y = rect.min.y(); y < rect.max.y(); ++y)
        for (int x = rect.min.x(); x < rect.max.x(); ++x)
            sum += Sqr(double(noise[size_t(y) * width + x]));
    return std::sqrt(sum / double(rect.Area()));
}

struct Jumps {
    std::span<const float> noise;
    int width;
    double sum = 0;
    int count = 0;

    // Adds the jumps across x = `line` between the rows `begin` and `end`, or with `upright` false
    // across y = `line` between those columns.
    void Add(bool upright, int line, int begin, int end) {
        for (int at = begin; at + kLength <= end; at += kLength) {
            const auto level = [&](int from, int to) {
                const PixelRect rect = upright ? PixelRect{{from, at}, {to, at + kLength}}
                                               : PixelRect{{at, from}, {at + kLength, to}};
                return RootMeanSquare(noise, width, rect);
            };
            sum += std::abs(level(line - kDepth, line) - level(line, line + kDepth));
            ++count;
        }
    }
    double Mean() const { return count > 0 ? sum / count : 0; }
};

void AddBorder(const PixelRect& a, const PixelRect& b, Jumps* jumps) {
    const auto deepEnough = [](int sideA, int sideB) { return std::min(sideA, sideB) >= kDepth; };
    if (a.max.x() == b.min.x() && a.min.y() == b.min.y() && deepEnough(a.Width(), b.Width()))
        jumps->Add(true, b.min.x(), a.min.y(), a.max.y());
    if (a.max.y() == b.min.y() && a.min.x() == b.min.x() && deepEnough(a.Height(), b.Height()))
        jumps->Add(false, b.min.y(), a.min.x(), a.max.x());
}

}  // namespace

double Seams::Ratio() const {
    return border > 0 && inside > 0 ? border / inside : std::numeric_limits<double>::quiet_NaN();
}

Seams MeasureSeams(std::span<const float> noise, int width, std::span<const PixelRect> blocks) {
    Jumps border{noise, width}, inside{noise, width};
    for (const PixelRect& a : blocks) {
        for (const PixelRect& b : blocks) AddBorder(a, b, &border);
        if (a.Width() >= 2 * kDepth)
            inside.Add(true, (a.min.x() + a.max.x()) / 2, a.min.y(), a.max.y());
        if (a.Height() >= 2 * kDepth)
            inside.Add(false, (a.min.y() + a.max.y()) / 2, a.min.x(), a.max.x());
    }
    return {border.Mean(), inside.Mean()};
}

namespace {

// Returns the luma less half of its range, as variances are differences of squares.
std::vector<float> CentredLuma(std::span<const uint8_t> srgb) {
    std::vector<float> luma;
    luma.reserve(srgb.size() / 3);
    for (size_t i = 0; i < srgb.size(); i += 3)
        luma.push_back(float(0.299 * srgb[i] + 0.587 * srgb[i + 1] + 0.114 * srgb[i + 2] - 127.5));
    return luma;
}

std::vector<float> Product(const std::vector<float>& a, const std::vector<float>& b) {
    std::vector<float> product(a.size());
    for (size_t i = 0; i < a.size(); ++i) product[i] = a[i] * b[i];
    return product;
}

}  // namespace

std::vector<float> SsimMap(std::span<const uint8_t> image, std::span<const uint8_t> reference,
                           int width, int height) {
    constexpr double c1 = (0.01 * 255) * (0.01 * 255), c2 = (0.03 * 255) * (0.03 * 255);
    const std::vector<double> window = GaussianKernel(1.5, kSsimRadius);
    const auto filter = [&](const std::vector<float>& values) {
        return Convolve(values, width, height, window, window);
    };
    const std::vector<float> x = CentredLuma(image), y = CentredLuma(reference);
    const std::vector<float> meanX = filter(x), meanY = filter(y);
    const std::vector<float> xx = filter(Product(x, x)), yy = filter(Product(y, y)),
                             xy = filter(Product(x, y));

    std::vector<float> map(x.size(), std::numeric_limits<float>::quiet_NaN());
    for (int row = kSsimRadius; row < height - kSsimRadius; ++row)
        for (int column = kSsimRadius; column < width - kSsimRadius; ++column) {
            const size_t i = size_t(row) * width + column;
            const double mx = meanX[i], my = meanY[i];
            const double varianceX = xx[i] - mx * mx, varianceY = yy[i] - my * my;
            const double covariance = xy[i] - mx * my;
            const double lx = mx + 127.5, ly = my + 127.5;
            map[i] = float((2 * lx * ly + c1) * (2 * covariance + c2) /
                           ((lx * lx + ly * ly + c1) * (varianceX + varianceY + c2)));
        }
    return map;
}

namespace {

using Triple = std::array<double, 3>;

// The names of the constants are the paper's.
constexpr double qc = 0.7, pc = 0.4, pt = 0.95, w = 0.082, qf = 0.5;

using ColourPlanes = std::array<std::vector<float>, 3>;

constexpr double kXyzFromRgb[3][3] = {{0.4123866, 0.3575915, 0.1804505},
                                      {0.2126369, 0.7151830, 0.0721801},
                                      {0.0193306, 0.1191971, 0.9503726}};
constexpr double kRgbFromXyz[3][3] = {{3.2410032, -1.5373990, -0.4986159},
                                      {-0.9692243, 1.8759300, 0.0415542},
                                      {0.0556394, -0.2040112, 1.0571490}};

Triple Apply(const double (&m)[3][3], const Triple& v) {
    Triple result;
    for (int i = 0; i < 3; ++i) result[i] = m[i][0] * v[0] + m[i][1] * v[1] + m[i][2] * v[2];
    return result;
}

const Triple& White() {
    static const Triple white = Apply(kXyzFromRgb, {1, 1, 1});
    return white;
}

// Transforms relative XYZ to and from the opponent space YCxCz, which is linear in them.
Triple YcxczFromRelative(const Triple& xyz) {
    return {116 * xyz[1] - 16, 500 * (xyz[0] - xyz[1]), 200 * (xyz[1] - xyz[2])};
}
Triple RelativeFromYcxcz(const Triple& c) {
    const double y = (c[0] + 16) / 116;
    return {y + c[1] / 500, y, y - c[2] / 200};
}

ColourPlanes OpponentPlanes(std::span<const uint8_t> srgb) {
    const std::array<double, 256>& linear = DecodeSrgb8();
    ColourPlanes planes;
    for (std::vector<float>& plane : planes) plane.reserve(srgb.size() / 3);
    for (size_t i = 0; i < srgb.size(); i += 3) {
        Triple xyz =
            Apply(kXyzFromRgb, {linear[srgb[i]], linear[srgb[i + 1]], linear[srgb[i + 2]]});
        for (int c = 0; c < 3; ++c) xyz[c] /= White()[c];
        const Triple opponent = YcxczFromRelative(xyz);
        for (int c = 0; c < 3; ++c) planes[c].push_back(float(opponent[c]));
    }
    return planes;
}

// Filters a plane with the contrast sensitivity a1 sqrt(pi / b1) exp(-pi^2 x^2 / b1) plus the same
// of a2 and b2, x in degrees; the weights sum to one (paper, section 4.1.1).
std::vector<float> FilterByContrast(const std::vector<float>& plane, int width, int height,
                                    std::array<double, 2> a, std::array<double, 2> b,
                                    double pixelsPerDegree) {
    constexpr double kLargestB = 0.04;
    const int radius =
        int(std::ceil(3 * std::sqrt(kLargestB / (2 * Sqr(std::numbers::pi))) * pixelsPerDegree));
    double weightSum = 0;
    std::vector<float> result(plane.size(), 0);
    std::array<double, 2> weights = {};
    for (int i = 0; i < 2; ++i) {
        if (a[i] == 0) continue;
        const double sigma = std::sqrt(b[i] / 2) / std::numbers::pi * pixelsPerDegree;
        double sum = 0;
        for (int x = -radius; x <= radius; ++x) sum += std::exp(-0.5 * Sqr(x / sigma));
        weights[i] = a[i] * std::sqrt(std::numbers::pi / b[i]) * sum * sum;
        weightSum += weights[i];
    }
    for (int i = 0; i < 2; ++i) {
        if (a[i] == 0) continue;
        const double sigma = std::sqrt(b[i] / 2) / std::numbers::pi * pixelsPerDegree;
        const std::vector<double> kernel = GaussianKernel(sigma, radius);
        const std::vector<float> filtered = Convolve(plane, width, height, kernel, kernel);
        for (size_t p = 0; p < plane.size(); ++p)
            result[p] += float(weights[i] / weightSum) * filtered[p];
    }
    return result;
}

// Returns L*a*b* of linear RGB, a* and b* times L* / 100: colours differ less in the dark (Hunt).
Triple HuntLab(const Triple& rgb) {
    Triple l = Apply(kXyzFromRgb, rgb);
    for (int c = 0; c < 3; ++c) l[c] = LightnessAt(l[c] / White()[c]).lightness;
    const double share = 0.01 * l[1] / 116;
    return {l[1], share * 500 * (l[0] - l[1]), share * 200 * (l[1] - l[2])};
}

// The distance that suits large differences of colour (paper, section 4.1.2).
double HyAb(const Triple& a, const Triple& b) {
    return std::abs(a[0] - b[0]) + std::hypot(a[1] - b[1], a[2] - b[2]);
}

// Maps the distance of two colours to [0, 1] (paper, section 4.1.3).
double RemapColour(double distance) {
    static const double largest = std::pow(HyAb(HuntLab({0, 1, 0}), HuntLab({0, 0, 1})), qc);
    const double d = std::pow(distance, qc), knee = pc * largest;
    return d < knee ? d * pt / knee : pt + (d - knee) / (largest - knee) * (1 - pt);
}

// Filters for contrast and returns the colours that are seen, in HuntLab.
std::vector<Triple> SeenColours(const ColourPlanes& planes, int width, int height, double ppd) {
    const std::array<std::vector<float>, 3> seen = {
        FilterByContrast(planes[0], width, height, {1, 0}, {0.0047, 1e-5}, ppd),
        FilterByContrast(planes[1], width, height, {1, 0}, {0.0053, 1e-5}, ppd),
        FilterByContrast(planes[2], width, height, {34.1, 13.5}, {0.04, 0.025}, ppd)};
    std::vector<Triple> colours;
    colours.reserve(planes[0].size());
    for (size_t i = 0; i < planes[0].size(); ++i) {
        Triple xyz = RelativeFromYcxcz({seen[0][i], seen[1][i], seen[2][i]});
        for (int c = 0; c < 3; ++c) xyz[c] *= White()[c];
        Triple rgb = Apply(kRgbFromXyz, xyz);
        for (double& v : rgb) v = std::clamp(v, 0.0, 1.0);
        colours.push_back(HuntLab(rgb));
    }
    return colours;
}

struct Features {
    std::vector<float> edges, points;
};

void BalanceSigns(std::vector<double>& kernel) {
    double positive = 0, negative = 0;
    for (const double k : kernel) (k > 0 ? positive : negative) += k;
    for (double& k : kernel) k /= k > 0 ? positive : -negative;
}

// Detects features in the achromatic plane by derivatives of a Gaussian (paper, section 4.2).
Features FindFeatures(const std::vector<float>& achromatic, int width, int height, double ppd) {
    const double sigma = 0.5 * w * ppd;
    const int radius = int(std::ceil(3 * sigma));
    const std::vector<double> smooth = GaussianKernel(sigma, radius);
    std::vector<double> first, second;
    for (int x = -radius; x <= radius; ++x) {
        const double g = std::exp(-0.5 * Sqr(x / sigma));
        first.push_back(-x * g);
        second.push_back((Sqr(x / sigma) - 1) * g);
    }
    BalanceSigns(first);
    BalanceSigns(second);

    std::vector<float> y(achromatic.size());
    std::ranges::transform(achromatic, y.begin(), [](float v) { return (v + 16) / 116; });
    const auto strength = [&](const std::vector<double>& kernel) {
        std::vector<float> alongX = Convolve(y, width, height, kernel, smooth);
        const std::vector<float> alongY = Convolve(y, width, height, smooth, kernel);
        for (size_t i = 0; i < alongX.size(); ++i) alongX[i] = std::hypot(alongX[i], alongY[i]);
        return alongX;
    };
    return {strength(first), strength(second)};
}

}  // namespace

double DefaultPixelsPerDegree() { return 0.7 * 3840 / 0.7 * std::numbers::pi / 180; }

std::vector<float> FlipMap(std::span<const uint8_t> image, std::span<const uint8_t> reference,
                           int width, int height, double ppd) {
    const ColourPlanes planes[2] = {OpponentPlanes(image), OpponentPlanes(reference)};
    const std::vector<Triple> colours[2] = {SeenColours(planes[0], width, height, ppd),
                                            SeenColours(planes[1], width, height, ppd)};
    const Features features[2] = {FindFeatures(planes[0][0], width, height, ppd),
                                  FindFeatures(planes[1][0], width, height, ppd)};
    std::vector<float> map(planes[0][0].size());
    for (size_t i = 0; i < map.size(); ++i) {
        const double colour = RemapColour(HyAb(colours[0][i], colours[1][i]));
        const double feature =
            std::max(std::abs(double(features[0].edges[i]) - double(features[1].edges[i])),
                     std::abs(double(features[0].points[i]) - double(features[1].points[i])));
        map[i] = float(std::pow(colour, 1 - std::pow(feature / std::numbers::sqrt2, qf)));
    }
    return map;
}

}  // namespace lull
