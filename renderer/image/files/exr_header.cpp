#include "renderer/image/files/exr_header.h"

#include <fmt/core.h>

#include <algorithm>
#include <cstdint>
#include <stdexcept>
#include <string>

#include "renderer/files/file_contents.h"

namespace lull {

namespace {

class HeaderBytes {
  public:
    explicit HeaderBytes(std::span<const std::byte> file) : rest(file) {}

    size_t Rest() const { return rest.size(); }
    std::span<const std::byte> Take(size_t count) {
        if (count > rest.size()) throw std::runtime_error("it is cut short");
        const std::span<const std::byte> taken = rest.first(count);
        rest = rest.subspan(count);
        return taken;
    }
    // Little endian.
    uint32_t Integer() {
        uint32_t value = 0;
        const std::span<const std::byte> bytes = Take(4);
        for (size_t i = 0; i < 4; ++i) value |= std::to_integer<uint32_t>(bytes[i]) << (8 * i);
        return value;
    }
    // Ends with a zero.
    std::string Text() {
        const size_t length = size_t(std::ranges::find(rest, std::byte{0}) - rest.begin());
        const char* text = reinterpret_cast<const char*>(Take(length + 1).data());
        return {text, length};
    }

  private:
    std::span<const std::byte> rest;
};

// The library reads the list to its end, wherever its attribute has its own.
void CheckChannels(std::span<const std::byte> list) {
    HeaderBytes bytes(list);
    while (!bytes.Text().empty()) bytes.Take(16);
    if (bytes.Rest() > 0) throw std::runtime_error("its list of channels is damaged");
}

}  // namespace

void CheckExrHeader(std::span<const std::byte> file) {
    HeaderBytes bytes(file);
    bytes.Take(4);  // the signature
    constexpr uint32_t kHasManyParts = 0x1000;
    const bool hasMany = bytes.Integer() & kHasManyParts;
    // A header for each part, of which the last of many is empty, and in each: name, type, size and
    // value of attributes, and an empty name.
    bool isEmpty = false;
    do {
        isEmpty = true;
        for (std::string name; !(name = bytes.Text()).empty(); isEmpty = false) {
            const std::string type = bytes.Text();
            const uint32_t size = bytes.Integer();
            if (size > bytes.Rest())
                throw std::runtime_error(
                    fmt::format("its attribute '{}' has {} bytes, of which {} are there",
                                Printable(name), size, bytes.Rest()));
            const std::span<const std::byte> value = bytes.Take(size);
            if (type == "chlist") CheckChannels(value);
        }
    } while (hasMany && !isEmpty);
}

}  // namespace lull
