// numpy arrays of images and of the numbers of their blocks.
#pragma once

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include <string>
#include <vector>

namespace lull {

// Gives a warning of Python's. Throws pybind11::error_already_set where Python makes it an error.
void Warn(const std::string& text);

// Throws pybind11::value_error unless an image has this size and at least so many channels, of
// which a single one needs no dimension.
void CheckShape(const pybind11::array& image, const std::string& name, pybind11::ssize_t height,
                pybind11::ssize_t width, int channels);

// Returns "2 x 3 x 4", and "float64".
std::string ShapeOf(const pybind11::array& array);
std::string TypeOf(const pybind11::array& array);

// Returns the first channels of an array of rows, columns and channels, in the same memory.
pybind11::array FirstChannels(const pybind11::array& pixels, int count);

// Warn of values that are not finite, which count as 0; of colours also where many are negative, or
// most above white, as in pictures of 0 to 255.
void WarnOfValues(const pybind11::array& values, const std::string& name);
void WarnOfColours(const pybind11::array& values, const std::string& name);

// Returns a number of all blocks as an array of rows x columns.
template <typename T, typename Block, typename Field>
pybind11::array_t<T> ValuesOf(const std::vector<Block>& blocks, int columns, Field Block::*field) {
    pybind11::array_t<T> values({int(blocks.size()) / columns, columns});
    for (size_t i = 0; i < blocks.size(); ++i) values.mutable_data()[i] = T(blocks[i].*field);
    return values;
}

}  // namespace lull
