#include "renderer/results/exr_windows.h"

#include <fmt/format.h>

#include <algorithm>

#include "renderer/base/error.h"
#include "renderer/base/memory.h"

namespace lull {

PixelRect DataWindow(const ExrImage& image) {
    return {image.origin, image.origin + Vec2i(image.width, image.height)};
}

PixelRect ShownWindow(const ExrImage& image, const std::string& file) {
    const bool isOwn = image.attributes.contains("criterion");
    if (isOwn || image.displaySize.minCoeff() < 1) return DataWindow(image);
    constexpr int kMostSide = 1 << 16;
    const PixelRect window{{0, 0}, image.displaySize};
    const std::string size = fmt::format("{}x{}", window.Width(), window.Height());
    if (image.displaySize.maxCoeff() > kMostSide)
        throw Error(fmt::format("{}: its display window of {} pixels is absurd", file, size));
    CheckMemory(window.Area() * int64_t(image.channels.size() * sizeof(float)),
                fmt::format("{}, whose display window has {} pixels,", file, size),
                "use a smaller version of it");
    return window;
}

std::vector<float> MovedTo(const PixelRect& window, const PixelRect& data, int channels,
                           const std::vector<float>& values) {
    if (window == data) return values;
    std::vector<float> moved(size_t(window.Area()) * size_t(channels));
    const Vec2i least = window.min.cwiseMax(data.min), most = window.max.cwiseMin(data.max);
    if ((least.array() >= most.array()).any()) return moved;
    const auto at = [&](const PixelRect& rect, int y) {
        return (int64_t(y - rect.min.y()) * rect.Width() + least.x() - rect.min.x()) * channels;
    };
    for (int y = least.y(); y < most.y(); ++y)
        std::copy_n(values.begin() + at(data, y), (most.x() - least.x()) * channels,
                    moved.begin() + at(window, y));
    return moved;
}

void MoveTo(const PixelRect& window, ExrImage* image) {
    const PixelRect data = DataWindow(*image);
    if (window == data) return;
    for (ExrChannel& channel : image->channels)
        channel.values = MovedTo(window, data, 1, channel.values);
    image->origin = window.min;
    image->width = window.Width();
    image->height = window.Height();
}

}  // namespace lull
