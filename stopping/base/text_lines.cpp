#include "stopping/base/text_lines.h"

#include <algorithm>
#include <istream>
#include <iterator>
#include <stdexcept>

#include "stopping/base/text_encoding.h"

namespace lull {

TextLines::TextLines(std::istream& in, const std::string& name)
    : name(name), text(std::istreambuf_iterator<char>(in), {}) {
    if (in.bad()) throw std::runtime_error(name + ": cannot be read");
    if (const std::string_view wide = WideEncoding(text); !wide.empty())
        throw std::runtime_error(name + ": the text is " + std::string(wide) +
                                 "; save it as UTF-8");
    if (text.starts_with(kByteOrderMark)) text.erase(0, kByteOrderMark.size());
    text.resize(WithoutEndMarks(text).size());
}

bool TextLines::Next() {
    if (next >= text.size()) return false;
    const size_t end = std::min(text.find_first_of("\r\n", next), text.size());
    line = text.substr(next, end - next);
    next = end + (text.compare(end, 2, "\r\n") == 0 ? 2 : 1);
    ++number;
    if (line.find_first_of(kEndMarks) != line.npos)
        throw std::runtime_error(name + ":" + std::to_string(number) +
                                 ": Control-Z or NUL, which mark the end of a text, with more text "
                                 "behind; remove one or the other");
    return true;
}

}  // namespace lull
