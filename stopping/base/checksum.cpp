#include "stopping/base/checksum.h"

#include <zlib.h>

#include <array>
#include <cstdio>
#include <fstream>
#include <stdexcept>

namespace lull {

std::string FileChecksum(const std::string& path) {
    std::ifstream file(path, std::ios::binary);
    std::array<char, 65536> buffer;
    uLong crc = crc32(0, nullptr, 0);
    while (file) {
        file.read(buffer.data(), buffer.size());
        crc = crc32(crc, reinterpret_cast<const Bytef*>(buffer.data()), uInt(file.gcount()));
    }
    if (!file.eof()) throw std::runtime_error(path + ": cannot be read");
    char text[16];
    std::snprintf(text, sizeof text, "crc32:%08lx", static_cast<unsigned long>(crc));
    return text;
}

}  // namespace lull
