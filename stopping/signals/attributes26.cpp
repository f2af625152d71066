#include "stopping/signals/attributes26.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace lull {

namespace {

constexpr int kReach = 2;  // pixels that a filter of 5x5 sees beyond its own

// An image with kReach pixels more at each side.
struct PaddedImage {
    int width, height;
    std::vector<double> values;

    PaddedImage(int width, int height)
        : width(width), height(height), values(size_t(Stride()) * size_t(height + 2 * kReach)) {}
    int Stride() const { return width + 2 * kReach; }
    // Points to (0, y) for y in [-kReach, height + kReach).
    double* Row(int y) { return &values[size_t((y + kReach) * Stride() + kReach)]; }
    const double* Row(int y) const { return &values[size_t((y + kReach) * Stride() + kReach)]; }
};

PaddedImage SurroundedByZeros(std::span<const double> image, int width, int height) {
    PaddedImage padded(width, height);
    for (int y = 0; y < height; ++y) std::copy_n(&image[size_t(y * width)], width, padded.Row(y));
    return padded;
}

PaddedImage Reflected(std::span<const double> image, int width, int height) {
    const auto reflect = [](int i, int n) { return i < 0 ? -i : i >= n ? 2 * n - 2 - i : i; };
    PaddedImage padded(width, height);
    for (int y = -kReach; y < height + kReach; ++y)
        for (int x = -kReach; x < width + kReach; ++x)
            padded.Row(y)[x] = image[size_t(reflect(y, height) * width + reflect(x, width))];
    return padded;
}

struct Taps {
    double w0, w1, w2;

    double operator()(const double* at, ptrdiff_t step) const {
        return w0 * at[0] + w1 * (at[-step] + at[step]) + w2 * (at[-2 * step] + at[2 * step]);
    }
};

Taps MeanTaps(int size) { return {1.0 / size, 1.0 / size, size > 3 ? 1.0 / size : 0}; }

Taps GaussianTaps(int size, double sigma) {
    const double w1 = std::exp(-0.5 / (sigma * sigma));
    const double w2 = size > 3 ? std::exp(-2 / (sigma * sigma)) : 0;
    const double sum = 1 + 2 * (w1 + w2);
    return {1 / sum, w1 / sum, w2 / sum};
}

void Smooth(const PaddedImage& image, const Taps& taps, PaddedImage* rows,
            std::span<double> filtered) {
    for (int y = -kReach; y < image.height + kReach; ++y) {
        const double* const from = image.Row(y);
        double* const to = rows->Row(y);
        for (int x = 0; x < image.width; ++x) to[x] = taps(from + x, 1);
    }
    for (int y = 0; y < image.height; ++y) {
        const double* const from = rows->Row(y);
        double* const to = &filtered[size_t(y * image.width)];
        for (int x = 0; x < image.width; ++x) to[x] = taps(from + x, image.Stride());
    }
}

// Returns the pairs of n values to put in order, one after the other, so that the median comes to
// the middle: Batcher's merge exchange (Knuth, TAOCP 3, 5.2.2, Algorithm M) without the pairs that
// do not affect the median.
std::vector<std::pair<int, int>> MedianNetwork(int n) {
    std::vector<std::pair<int, int>> pairs;
    for (int p = 1; p < n; p *= 2)
        for (int k = p; k >= 1; k /= 2)
            for (int j = k % p; j + k < n; j += 2 * k)
                for (int i = j; i < std::min(j + k, n - k); ++i)
                    if (i / (2 * p) == (i + k) / (2 * p)) pairs.emplace_back(i, i + k);
    std::vector<char> matters(size_t(n), 0);
    matters[size_t(n / 2)] = 1;
    std::vector<std::pair<int, int>> needed;
    for (auto pair = pairs.rbegin(); pair != pairs.rend(); ++pair) {
        char &a = matters[size_t(pair->first)], &b = matters[size_t(pair->second)];
        if (!a && !b) continue;
        a = b = 1;
        needed.push_back(*pair);
    }
    std::reverse(needed.begin(), needed.end());
    return needed;
}

template <int Size>
void Median(const PaddedImage& image, std::span<double> filtered) {
    static const std::vector<std::pair<int, int>> network = MedianNetwork(Size * Size);
    constexpr int kLanes = 64;
    double window[Size * Size][kLanes] = {};
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; x += kLanes) {
            const int count = std::min(kLanes, image.width - x);
            for (int v = 0; v < Size; ++v)
                for (int u = 0; u < Size; ++u)
                    std::copy_n(image.Row(y + v - Size / 2) + x + u - Size / 2, count,
                                window[v * Size + u]);
            for (const auto& [i, j] : network) {
                double *const a = window[i], *const b = window[j];
                for (int lane = 0; lane < kLanes; ++lane) {
                    const double low = std::min(a[lane], b[lane]);
                    const double high = std::max(a[lane], b[lane]);
                    a[lane] = low;
                    b[lane] = high;
                }
            }
            std::copy_n(window[Size * Size / 2], count, &filtered[size_t(y * image.width + x)]);
        }
}

// `squares` is image^2; `mean` and `variance` are memory to use, of the size of `filtered`.
void Wiener(const PaddedImage& image, const PaddedImage& squares, int size, PaddedImage* rows,
            std::span<double> mean, std::span<double> variance, std::span<double> filtered) {
    Smooth(image, MeanTaps(size), rows, mean);
    Smooth(squares, MeanTaps(size), rows, variance);
    double noise = 0;
    for (size_t i = 0; i < mean.size(); ++i) {
        variance[i] = std::max(variance[i] - mean[i] * mean[i], 0.0);
        noise += variance[i] / double(mean.size());
    }
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x) {
            const size_t i = size_t(y * image.width + x);
            const double share = variance[i] > noise ? 1 - noise / variance[i] : 0;
            filtered[i] = mean[i] + share * (image.Row(y)[x] - mean[i]);
        }
}

void CheckImage(std::span<const double> lightness, int width, int height) {
    if (width < 2 * kReach + 1 || height < 2 * kReach + 1)
        throw std::invalid_argument("a block of " + std::to_string(width) + "x" +
                                    std::to_string(height) + " pixels is too small to filter");
    if (lightness.size() != size_t(width) * size_t(height))
        throw std::invalid_argument("ComputeAttributes: width * height values are needed");
    if (!std::ranges::all_of(lightness, [](double v) { return std::isfinite(v); }))
        throw std::invalid_argument("attributes of a value that is not finite");
}

std::pair<double, double> Moments(std::span<const double> values) {
    double sum = 0, squares = 0;
    for (const double v : values) sum += v;
    const double mean = sum / double(values.size());
    for (const double v : values) squares += (v - mean) * (v - mean);
    const double deviation = std::sqrt(squares / double(values.size()));
    return {std::isfinite(mean) ? mean : 0, std::isfinite(deviation) ? deviation : 0};
}

}  // namespace

std::array<double, kAttributes> ComputeAttributes(std::span<const double> lightness, int width,
                                                  int height) {
    CheckImage(lightness, width, height);
    const PaddedImage reflected = Reflected(lightness, width, height);
    const PaddedImage image = SurroundedByZeros(lightness, width, height);
    PaddedImage squares = image, rows = image;
    for (double& v : squares.values) v *= v;
    std::vector<double> filtered(lightness.size()), mean(lightness.size()),
        variance(lightness.size());

    std::array<double, kAttributes> attributes = {};
    int filter = 0;
    const auto measure = [&] {
        for (size_t i = 0; i < filtered.size(); ++i)
            filtered[i] = std::abs(lightness[i] - filtered[i]);
        const auto [average, deviation] = Moments(filtered);
        attributes[size_t(filter)] = average;
        attributes[size_t(filter + kAttributes / 2)] = deviation;
        ++filter;
    };
    for (const int size : {3, 5}) {
        Smooth(reflected, MeanTaps(size), &rows, filtered);
        measure();
    }
    for (const int size : {3, 5})
        for (const double sigma : {0.5, 1.0, 1.5}) {
            Smooth(reflected, GaussianTaps(size, sigma), &rows, filtered);
            measure();
        }
    Median<3>(image, filtered);
    measure();
    Median<5>(image, filtered);
    measure();
    for (const int size : {3, 5}) {
        Wiener(image, squares, size, &rows, mean, variance, filtered);
        measure();
    }
    const double sigma = DiagonalNoise(lightness, width, height);
    const double threshold = sigma * std::sqrt(2 * std::log(double(lightness.size())));
    ShrinkDetails(lightness, width, height, threshold, filtered);
    measure();
    return attributes;
}

namespace {

// Takes, from each 2x2 pixels of `image`, the details below the threshold out of `rest` (of the
// same size, each value of which covers scale x scale of its pixels), and returns the averages,
// which are half as many a side.
std::vector<double> TakeDetails(std::span<const double> image, int width, int height,
                                double threshold, int scale, int restWidth, int restHeight,
                                std::span<double> rest) {
    const int halfWidth = (width + 1) / 2, halfHeight = (height + 1) / 2;
    std::vector<double> averages(size_t(halfWidth) * size_t(halfHeight));
    const auto small = [&](double v) { return std::abs(v) < threshold ? v / (2 * scale) : 0; };
    for (int y = 0; y < halfHeight; ++y)
        for (int x = 0; x < halfWidth; ++x) {
            const int x1 = std::min(2 * x + 1, width - 1), y1 = std::min(2 * y + 1, height - 1);
            const double a = image[size_t(2 * y * width + 2 * x)];
            const double b = image[size_t(2 * y * width + x1)];
            const double c = image[size_t(y1 * width + 2 * x)];
            const double d = image[size_t(y1 * width + x1)];
            averages[size_t(y * halfWidth + x)] = (a + b + c + d) / 2;
            const double along = small((a - b + c - d) / 2), across = small((a + b - c - d) / 2);
            const double diagonal = small((a - b - c + d) / 2);
            const int right = std::min((2 * x + 2) * scale, restWidth);
            const int bottom = std::min((2 * y + 2) * scale, restHeight);
            for (int v = 2 * y * scale; v < bottom; ++v)
                for (int u = 2 * x * scale; u < right; ++u) {
                    const double s = u < (2 * x + 1) * scale ? 1 : -1;
                    const double t = v < (2 * y + 1) * scale ? 1 : -1;
                    rest[size_t(v * restWidth + u)] -= s * along + t * across + s * t * diagonal;
                }
        }
    return averages;
}

}  // namespace

double DiagonalNoise(std::span<const double> image, int width, int height) {
    // The high-pass of Daubechies 2, to be folded with the image.
    const double root3 = std::sqrt(3.0), scale = 1 / (4 * std::sqrt(2.0));
    const double high[4] = {-(1 + root3) * scale, (3 + root3) * scale, -(3 - root3) * scale,
                            (1 - root3) * scale};
    const auto reflect = [](int i, int n) { return i < 0 ? -1 - i : i >= n ? 2 * n - 1 - i : i; };
    const int columns = (width + 3) / 2, lines = (height + 3) / 2;
    std::vector<double> filtered(size_t(columns) * size_t(height));
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < columns; ++x)
            for (int j = 0; j < 4; ++j)
                filtered[size_t(y * columns + x)] +=
                    high[j] * image[size_t(y * width + reflect(2 * x + 1 - j, width))];
    std::vector<double> details;
    details.reserve(size_t(columns) * size_t(lines));
    for (int y = 0; y < lines; ++y)
        for (int x = 0; x < columns; ++x) {
            double sum = 0;
            for (int j = 0; j < 4; ++j)
                sum += high[j] * filtered[size_t(reflect(2 * y + 1 - j, height) * columns + x)];
            if (sum != 0) details.push_back(std::abs(sum));
        }
    if (details.empty()) return 0;
    const auto middle = details.begin() + ptrdiff_t(details.size() / 2);
    std::nth_element(details.begin(), middle, details.end());
    const double above = *middle;
    const double below =
        details.size() % 2 == 1 ? above : *std::max_element(details.begin(), middle);
    return (below + above) / 2 / 0.674489750196081743;
}

void ShrinkDetails(std::span<const double> image, int width, int height, double threshold,
                   std::span<double> shrunk) {
    std::ranges::copy(image, shrunk.begin());
    const std::vector<double> averages =
        TakeDetails(image, width, height, threshold, 1, width, height, shrunk);
    TakeDetails(averages, (width + 1) / 2, (height + 1) / 2, threshold, 2, width, height, shrunk);
}

}  // namespace lull
