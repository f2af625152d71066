#include "stopping/python/arrays.h"

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

py::array FirstChannels(const py::array& pixels, int count) {
    return pixels[py::make_tuple(py::ellipsis(), py::slice(0, count, 1))];
}

void WarnOfValues(const py::array& values, const std::string& name) {
    const py::object isFinite = py::module_::import("numpy").attr("isfinite")(values);
    if (!isFinite.attr("all")().cast<bool>())
        Warn(name + " has values that are not finite; they count as 0");
}

}  // namespace lull
