#include "renderer/python/arrays.h"

#include <cmath>
#include <cstdint>

namespace lull {

namespace py = pybind11;

void Warn(const std::string& text) {
    if (PyErr_WarnEx(PyExc_UserWarning, text.c_str(), 1) != 0) throw py::error_already_set();
}

std::string ShapeOf(const py::array& array) {
    std::string text;
    for (py::ssize_t i = 0; i < array.ndim(); ++i)
        text += (i ? " x " : "") + std::to_string(array.shape(i));
    return text;
}

std::string TypeOf(const py::array& array) { return py::str(array.dtype()).cast<std::string>(); }

void CheckShape(const py::array& image, const std::string& name, py::ssize_t height,
                py::ssize_t width, int channels) {
    const bool isFlat = channels == 1 && image.ndim() == 2;
    if ((isFlat || image.ndim() == 3) && image.shape(0) == height && image.shape(1) == width &&
        (isFlat || image.shape(2) >= channels))
        return;
    throw py::value_error(name + " has the shape " + ShapeOf(image) + "; needed are " +
                          std::to_string(height) + " x " + std::to_string(width) + " x " +
                          std::to_string(channels) + ": rows, columns, channels");
}

py::array FirstChannels(const py::array& pixels, int count) {
    return pixels[py::make_tuple(py::ellipsis(), py::slice(0, count, 1))];
}

void WarnOfValues(const py::array& values, const std::string& name) {
    const py::object isFinite = py::module_::import("numpy").attr("isfinite")(values);
    if (!isFinite.attr("all")().cast<bool>())
        Warn(name + " has values that are not finite; they count as 0");
}

void WarnOfColours(const py::array& values, const std::string& name) {
    constexpr double kManyNegative = 0.05, kMost = 0.5;
    WarnOfValues(values, name);
    const auto share = [&](const char* comparison, int limit) {
        const py::object holds = py::module_::import("numpy").attr(comparison)(values, limit);
        return holds.attr("mean")().cast<double>();
    };
    if (share("less", 0) > kManyNegative)
        Warn(name + " has many negative values, which count as 0; linear radiance is needed");
    if (share("greater", 1) > kMost)
        Warn(name +
             " is mostly above 1, the display's white; divide images of 0 to 255 by 255 "
             "and undo their gamma, or scale it to how it is shown");
}

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
