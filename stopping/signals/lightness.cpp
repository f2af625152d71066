#include "stopping/signals/lightness.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <stdexcept>

namespace lull {

namespace {

// Rounds the sRGB curve without evaluating it: code c begins at the linear value start[c], and
// cell i of a uniform grid over [0, 1] begins with code first[i]. The curve is nowhere steeper
// than 12.92, so two codes begin at least 1 / (12.92 * 255) apart, which is more than a cell:
// one comparison settles the code.
struct EncodeTable {
    static constexpr int kCells = 4096;
    std::array<float, 257> start;
    std::array<uint8_t, kCells> first;

    EncodeTable() {
        for (int c = 0; c < 256; ++c) {
            const double exact = c == 0 ? 0 : DecodeSrgb((c - 0.5) / 255);
            start[c] = float(exact);
            if (start[c] < exact) start[c] = std::nextafter(start[c], 2.f);
        }
        start[256] = std::numeric_limits<float>::infinity();
        for (int i = 0, c = 0; i < kCells; ++i) {
            while (start[c + 1] <= float(i) / kCells) ++c;
            first[i] = uint8_t(c);
        }
    }

    uint8_t operator()(float x) const {
        if (!(x > 0)) return 0;  // false for NaN as well
        if (x >= 1) return 255;
        const int c = first[size_t(x * kCells)];
        return uint8_t(c + (x >= start[c + 1]));
    }
};

// The share of each 8-bit component in the luminance Y.
struct LuminanceTable {
    std::array<std::array<double, 256>, 3> share;

    LuminanceTable() {
        for (int i = 0; i < 3; ++i)
            for (int c = 0; c < 256; ++c) share[i][c] = kLuminanceWeights[i] * DecodeSrgb8()[c];
    }
};

}  // namespace

double DecodeSrgb(double v) {
    return v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4);
}

const std::array<double, 256>& DecodeSrgb8() {
    static const std::array<double, 256> table = [] {
        std::array<double, 256> linear;
        for (size_t code = 0; code < linear.size(); ++code)
            linear[code] = DecodeSrgb(double(code) / 255);
        return linear;
    }();
    return table;
}

void EncodeSrgb8(std::span<const float> linear, std::span<uint8_t> srgb) {
    if (linear.size() != srgb.size())
        throw std::invalid_argument("EncodeSrgb8: input and output differ in length");
    static const EncodeTable encode;
    std::transform(linear.begin(), linear.end(), srgb.begin(), std::cref(encode));
}

void Lightness(std::span<const uint8_t> srgb, std::span<double> lightness) {
    if (srgb.size() != 3 * lightness.size())
        throw std::invalid_argument("Lightness: three components a pixel are needed");
    static const LuminanceTable table;
    for (size_t i = 0; i < lightness.size(); ++i) {
        const double y = table.share[0][srgb[3 * i]] + table.share[1][srgb[3 * i + 1]] +
                         table.share[2][srgb[3 * i + 2]];
        lightness[i] = std::min(100.0, LightnessAt(y).lightness);
    }
}

double LuminanceOf(double lightness) {
    return lightness > 8 ? std::pow((lightness + 16) / 116, 3) : std::max(0.0, lightness) / 903.3;
}

std::vector<double> LightnessOf(std::span<const float> linear) {
    std::vector<uint8_t> srgb(linear.size());
    EncodeSrgb8(linear, srgb);
    std::vector<double> lightness(linear.size() / 3);
    Lightness(srgb, lightness);
    return lightness;
}

namespace {

constexpr double kBright = 4;

std::string Percent(size_t part, size_t whole) {
    return std::to_string(100 * part / whole) + " % of the pixels ";
}

}  // namespace

void PictureValues::Add(float r, float g, float b) {
    ++pixels;
    const double y = kLuminanceWeights[0] * double(r) + kLuminanceWeights[1] * double(g) +
                     kLuminanceWeights[2] * double(b);
    if (!std::isfinite(y)) {
        ++notFinite;
        return;
    }
    negative += y < 0;
    lit += y > 0;
    bright += y > kBright;
}

void PictureValues::Add(const PictureValues& other) {
    pixels += other.pixels;
    notFinite += other.notFinite;
    negative += other.negative;
    lit += other.lit;
    bright += other.bright;
}

std::string FaultOfValues(const PictureValues& v) {
    if (v.notFinite > v.pixels / 10)
        return Percent(v.notFinite, v.pixels) + "have values that are not finite";
    if (v.negative > v.pixels / 4)
        return Percent(v.negative, v.pixels) +
               "are negative; linear radiance is needed, no logarithms or differences";
    return "";
}

std::string FaultOfExposure(const PictureValues& v) {
    if (v.bright <= v.lit / 2) return "";
    return Percent(v.bright, v.pixels) +
           "are brighter than 4 times the display's white, which is 1; divide pictures of 0 to 255 "
           "by 255 and undo their gamma, or scale the picture to how it is shown";
}

}  // namespace lull
