#include "renderer/python/arrays.h"

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
             " is mostly above 1, the display's white; divide pictures of 0 to 255 by 255 "
             "and undo their gamma, or scale it to how it is shown");
}

}  // namespace lull
