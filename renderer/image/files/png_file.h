// Reads PNGs of all kinds.
#pragma once

#include <memory>
#include <span>

#include "renderer/formats/image_file.h"

namespace lull {

// Returns whether bytes begin like a PNG.
bool IsPng(std::span<const std::byte> bytes);

// Opens a PNG: less than 8 bits become 8, palettes RGB, and transparent colours an alpha channel. A
// gamma or a profile in the file changes no values. The bytes must outlive the result. Throws
// std::runtime_error with the reason, without a path.
std::unique_ptr<ImageFile> OpenPng(std::span<const std::byte> bytes);

}  // namespace lull
