// Writes the messages of tev's protocol (https://github.com/Tom94/tev, Ipc.h): a length of 32 bits
// that includes itself, a byte with the type, and the fields; texts end with a zero byte, and
// everything is little-endian.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace lull::tev {

// Creates an image in the viewer and shows it; one of the same name is replaced.
std::vector<std::byte> CreateImage(const std::string& name, int width, int height,
                                   std::span<const std::string> channels);

// Changes a rectangle of it, whose upper left corner is (x, y). `values` are row-major, the
// adjacent channels of a pixel.
std::vector<std::byte> UpdateImage(const std::string& name, std::span<const std::string> channels,
                                   int x, int y, int width, int height,
                                   std::span<const float> values);

}  // namespace lull::tev
