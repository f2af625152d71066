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

}  // namespace lull
