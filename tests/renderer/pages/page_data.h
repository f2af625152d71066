// Reads data from pages.
#pragma once

#include "renderer/pages/html_page.h"
#include "tests/renderer/files/test_files.h"

namespace lull {

// Returns the data that a page holds.
inline Json DataOf(const std::string& page) {
    const std::string open = "<script id=\"data\" type=\"application/json\">";
    const size_t begin = page.find(open) + open.size();
    return Json::parse(page.substr(begin, page.find("</script>", begin) - begin));
}

// Returns how many pixels a picture has: its header is known before it is decoded.
inline Vec2i PictureSize(const std::string& uri) {
    const std::string head = "data:image/png;base64,", digits = uri.substr(head.size(), 32);
    std::string bytes;
    for (size_t i = 0, bits = 0, have = 0; i < digits.size(); ++i) {
        const char c = digits[i];
        bits = bits << 6 | size_t(c >= 'a'   ? c - 'a' + 26
                                  : c >= 'A' ? c - 'A'
                                  : c >= '0' ? c - '0' + 52
                                  : c == '+' ? 62
                                             : 63);
        if ((have += 6) >= 8) bytes += char(bits >> (have -= 8) & 255);
    }
    const auto number = [&](size_t at) {
        return int(uint8_t(bytes[at + 2])) << 8 | int(uint8_t(bytes[at + 3]));
    };
    return {number(16), number(20)};
}

}  // namespace lull
