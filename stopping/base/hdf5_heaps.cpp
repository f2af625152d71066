#include "stopping/base/hdf5_heaps.h"

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <span>
#include <stdexcept>
#include <string_view>
#include <vector>

namespace lull {
namespace {

constexpr std::string_view kSignature("GCOL\1\0\0\0", 8);  // with the version
constexpr size_t kHeaderBytes = 16, kChunkBytes = size_t(1) << 20;

template <typename T>
T Load(std::span<const char> bytes, size_t at) {
    T value;
    std::memcpy(&value, &bytes[at], sizeof(T));
    return value;
}

// Checks the objects of a heap; `bytes` end with the heap or with the file.
void CheckHeap(std::span<const char> bytes) {
    for (size_t at = kHeaderBytes; at + kHeaderBytes <= bytes.size();) {
        const bool isFreeSpace = Load<uint16_t>(bytes, at) == 0;
        const auto size = Load<uint64_t>(bytes, at + 8);
        const size_t rest = bytes.size() - at;
        // The size of free space includes its header.
        if (isFreeSpace && size >= kHeaderBytes && size <= rest)
            at += size;
        else if (!isFreeSpace && size <= rest)
            at += kHeaderBytes + (size + 7) / 8 * 8;
        else
            throw std::runtime_error("cannot read its texts: a heap of them is damaged");
    }
}

}  // namespace

void CheckGlobalHeaps(std::FILE* file) {
    if (std::fseek(file, 0, SEEK_END) != 0) return;
    const long end = std::ftell(file);
    std::vector<char> bytes;
    const auto read = [&](long start, uint64_t most) -> std::span<const char> {
        bytes.resize(size_t(std::min(most, uint64_t(end - start))));
        if (std::fseek(file, start, SEEK_SET) != 0) return {};
        return {bytes.data(), std::fread(bytes.data(), 1, bytes.size(), file)};
    };
    for (long start = 0; end - start >= long(kHeaderBytes);) {
        const std::span<const char> chunk = read(start, kChunkBytes);
        if (chunk.size() < kHeaderBytes) return;
        const size_t found = std::string_view(chunk.data(), chunk.size()).find(kSignature);
        if (found == std::string_view::npos) {
            start += long(chunk.size() - kSignature.size() + 1);  // one may lie across the end
        } else if (found > 0) {
            start += long(found);  // the heap begins the next chunk
        } else {
            CheckHeap(read(start, Load<uint64_t>(chunk, 8)));
            start += long(kSignature.size());
        }
    }
}

}  // namespace lull
