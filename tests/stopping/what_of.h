// Catches exceptions of calls.
#pragma once

#include <stdexcept>
#include <string>

namespace lull {

// Returns the message of a std::runtime_error thrown by `call`; empty where none was thrown.
template <typename Call>
std::string WhatOf(const Call& call) {
    try {
        call();
    } catch (const std::runtime_error& error) {
        return error.what();
    }
    return "";
}

}  // namespace lull
