// Converts errors of the C interface to exceptions.
#pragma once

#include <lull/lull.h>
#include <pybind11/pybind11.h>

namespace lull {

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

}  // namespace lull
