// numpy arrays of images and of the numbers of their blocks.
#pragma once

#include <lull/lull.h>
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include <optional>
#include <string>
#include <vector>

namespace lull {

// Adds the functions svd_entropy(), attributes26() and denoise(), and the types of their results.
void BindFunctions(pybind11::module_& module);

// Converts errors of the C interface to exceptions.

// Throws ValueError, OSError (the parent of FileNotFoundError), MemoryError or RuntimeError, with
// lull_error_message(), unless the status is LULL_OK.
inline void Check(lull_status status) {
    namespace py = pybind11;
    if (status == LULL_OK) return;
    const char* message = lull_error_message();
    if (status == LULL_BAD_ARGUMENT) throw py::value_error(message);
    PyErr_SetString(status == LULL_BAD_FILE        ? PyExc_OSError
                    : status == LULL_OUT_OF_MEMORY ? PyExc_MemoryError
                                                   : PyExc_RuntimeError,
                    message);
    throw py::error_already_set();
}

// Gives a warning of Python's. Throws pybind11::error_already_set where Python makes it an error.
void Warn(const std::string& text);

// Throws pybind11::value_error unless an image has this size and as many channels or more.
void CheckShape(const pybind11::array& image, const std::string& name, pybind11::ssize_t height,
                pybind11::ssize_t width, int channels);

// Returns "2 x 3 x 4", and "float64".
std::string ShapeOf(const pybind11::array& array);
std::string TypeOf(const pybind11::array& array);

// Returns the first channels of an array of rows, columns and channels, in the same memory.
pybind11::array FirstChannels(const pybind11::array& pixels, int count);

// Warn of values that are not finite, which count as 0; of colours also where many are negative, or
// most above white, as in images of 0 to 255.
void WarnOfValues(const pybind11::array& values, const std::string& name);
void WarnOfColours(const pybind11::array& values, const std::string& name);

// Returns a number of all blocks as an array of rows x columns.
template <typename T, typename Block, typename Field>
pybind11::array_t<T> ValuesOf(const std::vector<Block>& blocks, int columns, Field Block::*field) {
    pybind11::array_t<T> values({int(blocks.size()) / columns, columns});
    for (size_t i = 0; i < blocks.size(); ++i) values.mutable_data()[i] = T(blocks[i].*field);
    return values;
}

// Shows numpy arrays to the C interface.

// Pixels of height x width x 3, float32 or uint8, with any strides but 0. Other floats are
// converted. Further channels, such as alpha, are left out, with a warning; others tell of
// values that are not finite, negative, or mostly above white.
class Picture {
  public:
    // Throws pybind11::value_error for other shapes and types.
    Picture(const pybind11::array& image, const std::optional<pybind11::array>& half, int width,
            int height);

    lull_image view = {};  // as long as this exists

  private:
    pybind11::array mean;
    std::optional<pybind11::array> half;
};

}  // namespace lull
