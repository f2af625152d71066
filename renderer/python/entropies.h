// The measurements of pictures that Python has: SVD-entropies and attributes.
#pragma once

#include <pybind11/pybind11.h>

namespace lull {

// Adds svd_entropy(), the type SvdEntropy of its results, and attributes26().
void BindEntropies(pybind11::module_& module);

}  // namespace lull
