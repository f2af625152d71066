#include "stopping/base/text_lines.h"

#include <algorithm>
#include <istream>
#include <iterator>
#include <stdexcept>

namespace lull {

namespace {

using namespace std::string_view_literals;

bool IsUtf16(std::string_view text) {
    if (text.starts_with("\xff\xfe"sv) || text.starts_with("\xfe\xff"sv)) return true;
    // Every second byte of an ASCII character is 0.
    return text.size() >= 4 && (text[0] == '\0') != (text[1] == '\0') &&
           (text[0] == '\0') == (text[2] == '\0') && (text[1] == '\0') == (text[3] == '\0');
}

}  // namespace

TextLines::TextLines(std::istream& in, const std::string& name)
    : text(std::istreambuf_iterator<char>(in), {}) {
    if (in.bad()) throw std::runtime_error(name + ": cannot be read");
    if (IsUtf16(text)) throw std::runtime_error(name + ": the text is UTF-16; save it as UTF-8");
    if (text.starts_with("\xef\xbb\xbf")) text.erase(0, 3);
    text.resize(std::min(text.find_first_of("\x1a\0"sv), text.size()));
}

bool TextLines::Next() {
    if (next >= text.size()) return false;
    const size_t end = std::min(text.find_first_of("\r\n", next), text.size());
    line = text.substr(next, end - next);
    next = end + (text.compare(end, 2, "\r\n") == 0 ? 2 : 1);
    ++number;
    return true;
}

}  // namespace lull
