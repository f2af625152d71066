// Shows numpy arrays to the C interface.
#pragma once

#include <lull/lull.h>
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include <optional>

namespace lull {

// Pixels of height x width x 3, float32 or uint8, with any strides but 0. Other floats are
// converted. Further channels, such as alpha, are left out, with a warning; others tell of
// values that are not finite, negative, or mostly above white.
class Picture {
  public:
    // Throws pybind11::value_error for other shapes and types.
    Picture(const pybind11::array& image, const std::optional<pybind11::array>& half, int width,
            int height);

    lull_picture view = {};  // as long as this exists

  private:
    pybind11::array mean;
    std::optional<pybind11::array> half;
};

}  // namespace lull
