// Identifies files read by rules, for the headers of images, and finds damaged
// files.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

namespace lull {

// Returns "crc32:" and the CRC-32 of a file in eight hexadecimal digits: it tells mixed-up files
// apart and is no protection against forgery. Throws std::runtime_error if it cannot be read.
std::string FileChecksum(const std::string& path);

// Returns the seal of the content of a file, to be appended to it: a mark, and the CRC-32 of all
// bytes before it, which any flipped bit changes. HDF5 ignores bytes after the end of its files.
std::string SealOf(std::span<const std::byte> content);
// Appends it.
void Seal(std::vector<std::byte>* content);

// Throws std::runtime_error, which does not name the file, if it cannot be read, or is not as it
// was when it was sealed.
void CheckSeal(const std::string& path);
// Checks the content of a file; returns it without the seal.
std::span<const std::byte> CheckSeal(std::span<const std::byte> content);

}  // namespace lull
