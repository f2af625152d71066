// Denoising for Python.
#pragma once

#include <pybind11/pybind11.h>

namespace lull {

// Adds denoise() and the type Denoised of its results.
void BindDenoising(pybind11::module_& module);

}  // namespace lull
