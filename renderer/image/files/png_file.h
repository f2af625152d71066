// Reads PNGs of all kinds.
#pragma once

#include <png.h>

#include <csetjmp>
#include <cstdio>
#include <memory>
#include <span>

#include "renderer/formats/formats.h"

namespace lull {

// Calls libpng, which leaves its functions by longjmp() if something is wrong.

struct PngError {
    char message[128] = "";
};

// For png_create_read_struct() and png_create_write_struct(), with a PngError.
[[noreturn]] inline void OnPngError(png_structp png, png_const_charp message) {
    auto* error = static_cast<PngError*>(png_get_error_ptr(png));
    std::snprintf(error->message, sizeof(error->message), "%s", message);
    png_longjmp(png, 1);
}
inline void OnPngWarning(png_structp, png_const_charp) {}

// Returns false if libpng, called by `call`, gives up: left midway then, `call` must own nothing.
template <typename Call>
bool TryPng(png_structp png, const Call& call) {
    if (setjmp(png_jmpbuf(png))) return false;
    call();
    return true;
}

bool IsPng(std::span<const std::byte> bytes);

// Opens a PNG: less than 8 bits become 8, palettes RGB, and transparent colours an alpha channel. A
// gamma or a profile in the file changes no values. The bytes must outlive the result. Throws
// std::runtime_error with the reason, without a path.
std::unique_ptr<ImageFile> OpenPng(std::span<const std::byte> bytes);

}  // namespace lull
