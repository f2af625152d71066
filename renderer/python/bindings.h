// The parts of the extension beside the Stopper.
#pragma once

#include <pybind11/pybind11.h>

namespace lull {

// Adds svd_entropy(), the type SvdEntropy of its results, and attributes26().
void BindEntropies(pybind11::module_& module);

// Adds denoise() and the type Denoised of its results.
void BindDenoising(pybind11::module_& module);

}  // namespace lull
