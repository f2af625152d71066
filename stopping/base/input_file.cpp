#include "stopping/base/input_file.h"

#include <cerrno>
#include <cstring>
#include <filesystem>
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

}  // namespace lull
