// Messages on numpy arrays of images.
#pragma once

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include <string>

namespace lull {

// Gives a warning of Python's. Throws pybind11::error_already_set where Python makes it an error.
void Warn(const std::string& text);

// Returns "2 x 3 x 4".
std::string ShapeOf(const pybind11::array& array);

// Returns the first channels of an array of rows, columns and channels, in the same memory.
pybind11::array FirstChannels(const pybind11::array& pixels, int count);

// Warn of values that are not finite, which count as 0; of colours also where many are negative, or
// most above white, as in pictures of 0 to 255.
void WarnOfValues(const pybind11::array& values, const std::string& name);
void WarnOfColours(const pybind11::array& values, const std::string& name);

}  // namespace lull
