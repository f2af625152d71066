#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <numbers>

#include "renderer/base/error.h"
#include "renderer/base/math.h"
#include "renderer/vision/visible_difference.h"
#include "stopping/signals/lightness.h"

namespace lull {

namespace {

struct Unit {
    std::string_view name;
    double DisplayModel::*value;
    double least, most;
};

constexpr Unit kUnits[] = {{"cd", &DisplayModel::peak, 1, 10000},
                           {"ppd", &DisplayModel::pixelsPerDegree, 5, 500},
                           {"lux", &DisplayModel::ambient, 0, 100000}};

[[noreturn]] void Fail(std::string_view text) {
    throw Error(
        "display '{}': a peak luminance from 1 to 10000 cd/m2, 5 to 500 pixels per degree and 0 to "
        "100000 lux are needed, as in 100cd,40ppd,250lux",
        text);
}

}  // namespace

DisplayModel ParseDisplay(std::string_view text) {
    DisplayModel display;
    bool isSet[std::size(kUnits)] = {};
    for (std::string_view rest = text;;) {
        const size_t comma = rest.find(',');
        const std::string_view part = rest.substr(0, comma);
        double value = 0;
        const char* end = part.data() + part.size();
        const auto [after, error] = std::from_chars(part.data(), end, value);
        const std::string_view name(after, size_t(end - after));
        size_t i = 0;
        while (i < std::size(kUnits) && kUnits[i].name != name) ++i;
        if (error != std::errc() || i == std::size(kUnits) || isSet[i]) Fail(text);
        if (!(value >= kUnits[i].least && value <= kUnits[i].most)) Fail(text);
        isSet[i] = true;
        display.*kUnits[i].value = value;
        if (comma == std::string_view::npos) return display;
        rest.remove_prefix(comma + 1);
    }
}

std::string NameOf(const DisplayModel& display) {
    return fmt::format("{}cd,{}ppd,{}lux", display.peak, display.pixelsPerDegree, display.ambient);
}

std::vector<float> DisplayedLight(std::span<const float> linear, const DisplayModel& display) {
    const double black = display.peak / display.contrast;
    const double veil = black + display.ambient * display.reflectance / std::numbers::pi;
    std::vector<float> light;
    light.reserve(linear.size());
    for (const float v : linear)
        light.push_back(float((display.peak - black) * double(Displayed(v)) + veil));
    return light;
}

namespace {

// Parameters by their names in the paper. A value that grows with luminance l is
// a (1 + b / l)^-c; one that also falls again has the factor 1 - (1 + d / l)^-e.
struct Growth {
    double a, b, c;
};

struct Mechanism {
    Growth peak;       // sensitivity
    Growth frequency;  // of the peak, cycles per degree
    double bandwidth;
    double truncation;  // how far sensitivity falls below the frequency of the peak
    double area, areaFrequency;
};

constexpr Mechanism kAchromatic = {{56.4947, 7.54726, 0.144532},
                                   {1.78119, 91.5718, 0.256682},
                                   0.000213047,
                                   0.100207,
                                   157.103,
                                   0.702338};
constexpr Mechanism kRedGreen = {
    {681.434, 38.0038, 0.480386}, {0.0178364, 0, 0}, 2.42104, 0, 2816.44, 0.0711058};
constexpr Mechanism kYellowViolet = {
    {166.683, 62.8974, 0.41193}, {0.00425753, 0, 0}, 2.68197, 0, 2.82789e7, 0.000635093};

double At(const Growth& growth, double luminance) {
    return growth.a * std::pow(1 + growth.b / luminance, -growth.c);
}

double Fall(double luminance) {
    constexpr double d = 5.58341e-7, e = 9.66862e9;
    return -std::expm1(-e * std::log1p(d / luminance));
}

}  // namespace

double ContrastSensitivity(OpponentChannel channel, const GaborPatch& patch) {
    const bool isAchromatic = channel == OpponentChannel::Achromatic;
    const Mechanism& m = isAchromatic                           ? kAchromatic
                         : channel == OpponentChannel::RedGreen ? kRedGreen
                                                                : kYellowViolet;
    double peak = At(m.peak, patch.luminance);
    if (isAchromatic) peak *= Fall(patch.luminance);
    const double peakFrequency = At(m.frequency, patch.luminance);
    double response =
        std::pow(10, -Sqr(std::log10(patch.frequency / peakFrequency)) / std::exp2(m.bandwidth));
    if (patch.frequency < peakFrequency) response = std::max(response, 1 - m.truncation);
    // How sensitivity grows with area (Rovamo, Luntinen, Nasanen: Modelling the dependence of
    // contrast sensitivity on grating area and spatial frequency, Vision Research 33, 1993).
    const double criticalArea = m.area / (1 + Sqr(patch.frequency / m.areaFrequency));
    return peak * response * std::sqrt(criticalArea / (1 + criticalArea / patch.area)) *
           patch.frequency;
}

namespace {

void AddRow(const float* from, double weight, int width, double* to) {
    for (int x = 0; x < width; ++x) to[x] += weight * double(from[x]);
}

}  // namespace

std::vector<float> Convolve(std::span<const float> image, int width, int height,
                            std::span<const double> alongX, std::span<const double> alongY) {
    const int radiusX = int(alongX.size()) / 2, radiusY = int(alongY.size()) / 2;
    std::vector<float> rows(image.size()), result(image.size());
    std::vector<float> padded(size_t(width + 2 * radiusX));
    std::vector<double> sums(size_t(width), 0);
    const auto store = [&](std::vector<float>& to, int y) {
        for (int x = 0; x < width; ++x) to[size_t(y) * width + x] = float(sums[x]);
    };

    for (int y = 0; y < height; ++y) {
        const float* row = &image[size_t(y) * width];
        for (int x = 0; x < int(padded.size()); ++x)
            padded[x] = row[std::clamp(x - radiusX, 0, width - 1)];
        std::ranges::fill(sums, 0);
        for (size_t i = 0; i < alongX.size(); ++i) AddRow(&padded[i], alongX[i], width, &sums[0]);
        store(rows, y);
    }
    for (int y = 0; y < height; ++y) {
        std::ranges::fill(sums, 0);
        for (int i = 0; i < int(alongY.size()); ++i) {
            const int from = std::clamp(y + i - radiusY, 0, height - 1);
            AddRow(&rows[size_t(from) * width], alongY[i], width, &sums[0]);
        }
        store(result, y);
    }
    return result;
}

std::vector<double> GaussianKernel(double sigma, int radius) {
    std::vector<double> kernel;
    double sum = 0;
    for (int x = -radius; x <= radius; ++x) {
        kernel.push_back(std::exp(-0.5 * x * x / (sigma * sigma)));
        sum += kernel.back();
    }
    for (double& k : kernel) k /= sum;
    return kernel;
}

namespace {

constexpr float kKernel[3] = {0.4f, 0.25f, 0.05f};  // from the centre on

int Mirrored(int i, int size) {
    return std::clamp(i < 0 ? -1 - i : i >= size ? 2 * size - 1 - i : i, 0, size - 1);
}

template <typename Value>
struct Line {
    Value* values;
    int size;
    size_t stride;
    Value& operator[](int i) const { return values[size_t(i) * stride]; }
};

void ReduceLine(const Line<const float>& from, const Line<float>& to) {
    for (int i = 0; i < to.size; ++i) {
        const auto at = [&](int offset) { return from[Mirrored(2 * i + offset, from.size)]; };
        to[i] = kKernel[0] * at(0) + kKernel[1] * (at(-1) + at(1)) + kKernel[2] * (at(-2) + at(2));
    }
}

void ExpandLine(const Line<const float>& from, const Line<float>& to) {
    for (int i = 0; i < to.size; ++i) {
        const int j = i / 2, next = std::min(j + 1, from.size - 1);
        to[i] =
            i % 2
                ? 2 * kKernel[1] * (from[j] + from[next])
                : 2 * (kKernel[0] * from[j] + kKernel[2] * (from[std::max(j - 1, 0)] + from[next]));
    }
}

template <typename Filter>
Plane Separably(const Plane& from, int width, int height, const Filter& filter) {
    Plane rows{width, from.height, std::vector<float>(size_t(width) * size_t(from.height))};
    for (int y = 0; y < from.height; ++y)
        filter(Line<const float>{&from.values[size_t(y) * size_t(from.width)], from.width, 1},
               Line<float>{&rows.values[size_t(y) * size_t(width)], width, 1});
    Plane to{width, height, std::vector<float>(size_t(width) * size_t(height))};
    for (int x = 0; x < width; ++x)
        filter(Line<const float>{&rows.values[size_t(x)], rows.height, size_t(width)},
               Line<float>{&to.values[size_t(x)], height, size_t(width)});
    return to;
}

}  // namespace

Plane Reduce(const Plane& plane) {
    return Separably(plane, (plane.width + 1) / 2, (plane.height + 1) / 2,
                     [](const auto& from, const auto& to) { ReduceLine(from, to); });
}

Plane Expand(const Plane& plane, int width, int height) {
    return Separably(plane, width, height,
                     [](const auto& from, const auto& to) { ExpandLine(from, to); });
}

}  // namespace lull
