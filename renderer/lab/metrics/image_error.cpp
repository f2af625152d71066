#include "renderer/lab/metrics/image_error.h"

#include <fmt/core.h>

#include <limits>

#include "renderer/base/error.h"
#include "renderer/lab/metrics/flip.h"
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

// Decodes 8-bit sRGB values.
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

// Averages jumps.
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

// Adds the border between two blocks of which the second is to the right of the first or below.
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

// Returns the luma less half of its range: variances are differences of large numbers, which
// lose the less the smaller these are.
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

}  // namespace lull
