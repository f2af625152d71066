#include "stopping/base/checksum.h"

#include <zlib.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <stdexcept>

#include "stopping/base/input_file.h"

namespace lull {

namespace {

constexpr size_t kSealSize = 24;  // "lull seal crc32:" and eight digits

uLong Continue(uLong crc, std::span<const std::byte> bytes) {
    return crc32_z(crc, reinterpret_cast<const Bytef*>(bytes.data()), bytes.size());
}

std::string Text(uLong crc) {
    char text[16];
    std::snprintf(text, sizeof text, "crc32:%08lx", static_cast<unsigned long>(crc));
    return text;
}

std::string SealOf(uLong crc) { return "lull seal " + Text(crc); }

// Calls visit(bytes) with one part of the next `size` bytes of the file after the other.
template <typename Visit>
void ForEachPart(std::istream& file, uint64_t size, const Visit& visit) {
    std::array<char, 65536> buffer;
    while (size > 0 && file) {
        file.read(buffer.data(), std::streamsize(std::min<uint64_t>(size, buffer.size())));
        visit(std::as_bytes(std::span(buffer.data(), size_t(file.gcount()))));
        size -= uint64_t(file.gcount());
    }
}

void CheckSeal(uLong crc, const std::string& seal) {
    const std::string expected = SealOf(crc);
    if (seal == expected) return;
    if (seal.substr(0, 10) != expected.substr(0, 10))
        throw std::runtime_error("it is cut short, or is not of this version of the program");
    throw std::runtime_error("it is damaged: its content does not match its checksum");
}

}  // namespace

std::string FileChecksum(const std::string& path) {
    std::ifstream file = OpenInput(path);
    uLong crc = 0;
    ForEachPart(file, ~uint64_t(0), [&](const auto& part) { crc = Continue(crc, part); });
    if (!file.eof()) throw std::runtime_error(path + ": cannot be read");
    return Text(crc);
}

std::string SealOf(std::span<const std::byte> content) { return SealOf(Continue(0, content)); }

void Seal(std::vector<std::byte>* content) {
    const std::string seal = SealOf(*content);
    const auto bytes = std::as_bytes(std::span(seal));
    content->insert(content->end(), bytes.begin(), bytes.end());
}

void CheckSeal(const std::string& path) {
    if (const std::string reason = ReasonNotToRead(path); !reason.empty())
        throw std::runtime_error("cannot read it: " + reason);
    std::ifstream file(path, std::ios::binary);
    if (!file) throw std::runtime_error(std::string("cannot read it: ") + std::strerror(errno));
    const std::streamoff end = file.seekg(0, std::ios::end).tellg();
    file.seekg(0);
    uLong crc = 0;
    if (end >= std::streamoff(kSealSize))
        ForEachPart(file, uint64_t(end) - kSealSize,
                    [&](const auto& part) { crc = Continue(crc, part); });
    std::string seal(kSealSize, 0);
    file.read(seal.data(), kSealSize);
    CheckSeal(crc, seal);
}

std::span<const std::byte> CheckSeal(std::span<const std::byte> content) {
    const size_t size = content.size() - std::min(content.size(), kSealSize);
    const auto seal = content.subspan(size);
    CheckSeal(Continue(0, content.first(size)),
              {reinterpret_cast<const char*>(seal.data()), seal.size()});
    return content.first(size);
}

}  // namespace lull
