#include "renderer/base/utf8.h"

#include <algorithm>
#include <cstdint>

namespace lull {

size_t CharacterBytes(std::string_view text) {
    if (text.empty()) return 0;
    const auto first = static_cast<unsigned char>(text[0]);
    if (first < 0x80) return 1;
    const size_t length = first < 0xc2 ? 0 : first < 0xe0 ? 2 : first < 0xf0 ? 3 : 4;
    if (length == 0 || text.size() < length) return 0;
    uint32_t code = first & (0x7f >> length);
    for (const char c : text.substr(1, length - 1)) {
        if (!IsWithinCharacter(c)) return 0;
        code = code << 6 | (static_cast<unsigned char>(c) & 0x3f);
    }
    constexpr uint32_t kLeast[] = {0, 0, 0x80, 0x800, 0x10000};  // smaller ones have fewer bytes
    const bool isSurrogate = code >= 0xd800 && code < 0xe000;
    return code < kLeast[length] || code > 0x10ffff || isSurrogate ? 0 : length;
}

std::string ToUtf8(std::string_view text) {
    std::string utf8;
    while (!text.empty()) {
        const size_t bytes = CharacterBytes(text);
        utf8 += bytes == 0 || text[0] == '\0' ? "\xef\xbf\xbd" : text.substr(0, bytes);
        text.remove_prefix(std::max<size_t>(bytes, 1));
    }
    return utf8;
}

std::string BeginningOf(const std::string& text, size_t most) {
    if (text.size() <= most) return text;
    while (most > 0 && IsWithinCharacter(text[most])) --most;
    return text.substr(0, most);
}

}  // namespace lull
