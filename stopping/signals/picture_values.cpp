#include "stopping/signals/picture_values.h"

#include <cmath>

#include "stopping/signals/lightness.h"

namespace lull {

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
