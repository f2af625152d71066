#include "stopping/base/text_encoding.h"

#include <algorithm>
#include <cstddef>

namespace lull {

using namespace std::string_view_literals;

std::string_view WideEncoding(std::string_view bytes) {
    if (bytes.starts_with("\xff\xfe\0\0"sv) || bytes.starts_with("\0\0\xfe\xff"sv)) return "UTF-32";
    const bool isEven = bytes.size() % 2 == 0;
    if (isEven && (bytes.starts_with("\xff\xfe"sv) || bytes.starts_with("\xfe\xff"sv)))
        return "UTF-16";
    // Of characters that every text is full of, one byte of two, or three of four, is 0.
    constexpr size_t kLookedAt = 1024, kLeast = 8;
    const size_t size = std::min(kLookedAt, bytes.size()) / 4 * 4;
    if (size < kLeast) return "";
    size_t zeros[4] = {};
    for (size_t i = 0; i < size; ++i) zeros[i % 4] += bytes[i] == '\0';
    const size_t rows = size / 4, many = rows - rows / 8, few = rows / 8;
    const auto isWide = [&](std::string_view pattern) {  // z: zeros
        for (size_t i = 0; i < 4; ++i)
            if (pattern[i] == 'z' ? zeros[i] < many : zeros[i] > few) return false;
        return true;
    };
    if (isWide("xzzz") || isWide("zzzx")) return "UTF-32";
    return isWide("xzxz") || isWide("zxzx") ? "UTF-16" : "";
}

std::string_view WithoutEndMarks(std::string_view text) {
    const size_t last = text.find_last_not_of("\x1a\0 \t\r\n"sv);
    if (last == text.npos) return text;  // there is no text that these would end
    return text.substr(0, text.find_first_of(kEndMarks, last + 1));
}

}  // namespace lull
