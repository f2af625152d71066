#include "renderer/python/picture.h"

#include <cmath>
#include <cstdint>
#include <cstdlib>

#include "renderer/python/arrays.h"

namespace lull {

namespace py = pybind11;

namespace {

py::array ToPixels(const py::array& array, const std::string& name, int width, int height) {
    CheckShape(array, name, height, width, 3);
    if (array.shape(2) > 3)
        Warn(name + " has " + std::to_string(array.shape(2)) +
             " channels, of which R, G and B are used without alpha; give " + name +
             "[..., :3] of the image over its background");
    if (py::isinstance<py::array_t<uint8_t>>(array)) return array;
    if (array.dtype().kind() != 'f')
        throw py::value_error(name + " has the type " + TypeOf(array) +
                              "; float32 (linear) or uint8 (sRGB) is needed");
    WarnOfColours(FirstChannels(array, 3), name);
    return py::isinstance<py::array_t<float>>(array) ? array : py::array_t<float>(array);
}

// Returns an array with the same pixels, R, G and B side by side.
py::array Packed(const py::array& pixels) {
    return py::module_::import("numpy").attr("array")(FirstChannels(pixels, 3),
                                                      py::arg("order") = "C");
}

// Returns whether the library can be shown an array as it is: rows apart from each other, and no
// room for a fourth channel, of which it would tell once more.
bool IsPlain(const py::array& pixels) {
    const auto row = std::abs(pixels.strides(0)), pixel = std::abs(pixels.strides(1));
    const bool overlaps = row < pixel * pixels.shape(1) && pixel < row * pixels.shape(0);
    return !overlaps && pixel != 4 * std::abs(pixels.strides(2));
}

}  // namespace

Picture::Picture(const py::array& image, const std::optional<py::array>& other, int width,
                 int height)
    : mean(ToPixels(image, "image", width, height)) {
    bool isPlain = true;
    if (other) half = ToPixels(*other, "half", width, height);
    if (half && half->itemsize() != mean.itemsize())
        throw py::value_error("image and half have different types");
    for (int i = 0; i < 3; ++i)
        isPlain = isPlain && mean.strides(i) != 0 && (!half || half->strides(i) == mean.strides(i));
    isPlain = isPlain && IsPlain(mean);
    if (!isPlain) {
        mean = Packed(mean);
        if (half) half = Packed(*half);
    }
    view.width = width;
    view.height = height;
    view.format = mean.itemsize() == 1 ? LULL_SRGB8 : LULL_LINEAR_FLOAT;
    view.mean = mean.data();
    view.half = half ? half->data() : nullptr;
    view.row_stride = mean.strides(0);
    view.pixel_stride = mean.strides(1);
    view.channel_stride = mean.strides(2);
}

}  // namespace lull
