#include "renderer/embedding/picture.h"

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <stdexcept>
#include <string>

#include "stopping/signals/lightness.h"

namespace lull {

namespace {

// Values need not be aligned: strides are in bytes.
float AsItIs(const std::byte* at) {
    float value;
    std::memcpy(&value, at, sizeof(value));
    return value;
}

float FromFloat(const std::byte* at) {
    const float value = AsItIs(at);
    return std::isfinite(value) ? value : 0;
}

float FromSrgb8(const std::byte* at) { return float(DecodeSrgb8()[std::to_integer<size_t>(*at)]); }

struct Strides {
    ptrdiff_t row, pixel, channel;
};

Strides StridesOf(const lull_image& picture) {
    const ptrdiff_t size = picture.format == LULL_SRGB8 ? 1 : sizeof(float);
    Strides strides{picture.row_stride, picture.pixel_stride, picture.channel_stride};
    if (strides.channel == 0) strides.channel = size;
    if (strides.pixel == 0) strides.pixel = 3 * size;
    if (strides.row == 0) strides.row = picture.width * strides.pixel;
    return strides;
}

// Throws std::invalid_argument where a row begins within another one. Columns may lie within rows.
void CheckRows(const lull_image& picture) {
    const Strides s = StridesOf(picture);
    const auto size = [](ptrdiff_t bytes) { return int64_t(std::abs(bytes)); };
    const int64_t row = size(s.row), pixel = size(s.pixel);
    if (row >= pixel * picture.width || pixel >= row * picture.height) return;
    throw std::invalid_argument("rows of an image overlap: row_stride is " + std::to_string(s.row) +
                                " bytes, and a row of " + std::to_string(picture.width) +
                                " pixels has " + std::to_string(pixel * picture.width) +
                                "; strides are in bytes, and 0 means rows without gaps");
}

template <typename Read>
std::vector<float> ReadWith(Read read, const Strides& strides, const std::byte* origin,
                            const lull_rect& part) {
    std::vector<float> linear;
    linear.reserve(3 * size_t(part.width) * size_t(part.height));
    for (int y = part.y; y < part.y + part.height; ++y)
        for (int x = part.x; x < part.x + part.width; ++x)
            for (int c = 0; c < 3; ++c)
                linear.push_back(
                    read(origin + y * strides.row + x * strides.pixel + c * strides.channel));
    return linear;
}

}  // namespace

void CheckPicture(const lull_image& picture, int width, int height, bool needsHalf) {
    if (picture.width != width || picture.height != height)
        throw std::invalid_argument("an image of " + std::to_string(picture.width) + "x" +
                                    std::to_string(picture.height) + " pixels was shown where " +
                                    std::to_string(width) + "x" + std::to_string(height) +
                                    " are needed");
    if (picture.format != LULL_LINEAR_FLOAT && picture.format != LULL_SRGB8)
        throw std::invalid_argument(
            "the format of an image must be LULL_LINEAR_FLOAT or LULL_SRGB8");
    if (!picture.mean) throw std::invalid_argument("an image without pixels: mean is null");
    CheckRows(picture);
    if (needsHalf && !picture.half)
        throw std::invalid_argument(
            "the stopping rule needs a half buffer, which the image does not have; pass it, or "
            "choose a rule that needs none, such as the model 'entropy'");
}

std::vector<float> ReadPixels(const lull_image& picture, const void* origin,
                              const lull_rect& part) {
    const auto* bytes = static_cast<const std::byte*>(origin);
    const Strides strides = StridesOf(picture);
    return picture.format == LULL_SRGB8 ? ReadWith(FromSrgb8, strides, bytes, part)
                                        : ReadWith(FromFloat, strides, bytes, part);
}

std::vector<double> LightnessOf(const lull_image& picture) {
    const auto isSide = [](int pixels) { return pixels > 0 && pixels <= kLargestSide; };
    if (!isSide(picture.width) || !isSide(picture.height))
        throw std::invalid_argument("an image of " + std::to_string(picture.width) + "x" +
                                    std::to_string(picture.height) +
                                    " pixels; it must have 1 to 65536 a side");
    CheckPicture(picture, picture.width, picture.height, false);
    const lull_rect whole{0, 0, picture.width, picture.height};
    return LightnessOf(ReadPixels(picture, picture.mean, whole));
}

bool HasMeanAsHalf(const lull_image& picture, const lull_rect& part) {
    if (!picture.half) return false;
    if (picture.half == picture.mean) return true;
    if (picture.format == LULL_SRGB8) return false;
    const std::vector<float> mean = ReadPixels(picture, picture.mean, part);
    bool isEven = true;
    for (size_t i = 3; i < mean.size() && isEven; ++i) isEven = mean[i] == mean[i - 3];
    return !isEven && mean == ReadPixels(picture, picture.half, part);
}

bool HasFourthChannel(const lull_image& picture) {
    const Strides s = StridesOf(picture);
    return std::abs(s.pixel) == 4 * std::abs(s.channel);
}

PictureValues ValuesOf(const lull_image& picture, const void* origin, const lull_rect& part) {
    PictureValues values;
    if (picture.format == LULL_SRGB8) return values;
    const std::vector<float> rgb =
        ReadWith(AsItIs, StridesOf(picture), static_cast<const std::byte*>(origin), part);
    for (size_t i = 0; i < rgb.size(); i += 3) values.Add(rgb[i], rgb[i + 1], rgb[i + 2]);
    return values;
}

}  // namespace lull
