// Reads PNGs of all kinds.
#pragma once

#include <memory>
#include <span>

#include "renderer/formats/image_file.h"

namespace lull {

// Says whether bytes begin as a PNG does.
bool IsPng(std::span<const std::byte> bytes);

// Opens a PNG: less than 8 bits become 8, palettes RGB, and transparent colours an alpha channel.
// No value is changed for a gamma or a profile that the file names. The bytes must outlive what is
// returned. Throws std::runtime_error with the reason, without a path.
std::unique_ptr<ImageFile> OpenPng(std::span<const std::byte> bytes);

}  // namespace lull
