#include "stopping/base/input_file.h"

#include <algorithm>
#include <cerrno>
#include <cstddef>
#include <cstring>
#include <filesystem>
#include <istream>
#include <iterator>
#include <stdexcept>

namespace lull {

std::string ReasonNotToRead(const std::string& path) {
    // A name with a NUL byte would silently stand for its beginning.
    if (path.find('\0') != std::string::npos) return "the name holds a NUL character";
    std::error_code error;
    const std::filesystem::file_status status = std::filesystem::status(path, error);
    if (std::filesystem::is_regular_file(status)) return "";
    if (std::filesystem::is_directory(status)) return "it is a directory; name a file in it";
    if (std::filesystem::exists(status)) return "it is not a regular file";
    return error ? error.message() : std::strerror(ENOENT);
}

bool IsThere(const std::string& path) {
    std::error_code error;
    const std::filesystem::file_type type = std::filesystem::status(path, error).type();
    if (type == std::filesystem::file_type::none)
        throw std::runtime_error(path + ": " + error.message());
    return type != std::filesystem::file_type::not_found;
}

std::ifstream OpenInput(const std::string& path) {
    if (const std::string reason = ReasonNotToRead(path); !reason.empty())
        throw std::runtime_error(path + ": " + reason);
    errno = 0;
    std::ifstream file(path, std::ios::binary);
    if (!file)
        throw std::runtime_error(path + ": " + (errno ? std::strerror(errno) : "cannot be opened"));
    return file;
}

std::string Printable(std::string_view text, size_t most) {
    constexpr char kDigits[] = "0123456789abcdef";
    std::string result;
    for (const char c : text.substr(0, most)) {
        const auto byte = static_cast<unsigned char>(c);
        if (byte >= 0x20 && byte < 0x7f)
            result += c;
        else
            result += {'\\', 'x', kDigits[byte >> 4], kDigits[byte & 15]};
    }
    if (text.size() > most) result += "...";
    return result;
}

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
