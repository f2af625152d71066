#include "stopping/base/input_file.h"

#include <zlib.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
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
