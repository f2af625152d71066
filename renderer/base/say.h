// Prints messages to stderr: progress, warnings, summaries.
#pragma once

#include <fmt/format.h>

#include <cstdio>
#include <system_error>
#include <utility>

namespace lull {

// Prints to the stream. Where that cannot be written any more, as its terminal is closed or its
// disk is full, nothing is printed, and the work continues.
template <typename... Args>
void SayTo(std::FILE* stream, fmt::format_string<Args...> format, Args&&... args) {
    try {
        fmt::print(stream, format, std::forward<Args>(args)...);
    } catch (const std::system_error&) {
    }
}

// Prints to stderr.
template <typename... Args>
void Say(fmt::format_string<Args...> format, Args&&... args) {
    SayTo(stderr, format, std::forward<Args>(args)...);
}

}  // namespace lull
