// Helps tests that read and write files.
#pragma once

#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <string_view>

#include "renderer/base/error.h"
#include "tests/expect_has.h"

namespace lull {

inline std::string ReadBytes(const std::string& path) {
    std::ifstream in(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
}

// Gives a test a directory of its own, gone with everything in it when the test ends.
struct TemporaryDirectory {
    std::filesystem::path path;

    TemporaryDirectory() {
        std::string name = (std::filesystem::temp_directory_path() / "lull_test_XXXXXX").string();
        if (!mkdtemp(name.data())) throw Error("cannot make a directory for the test");
        path = name;
    }
    TemporaryDirectory(const TemporaryDirectory&) = delete;
    TemporaryDirectory& operator=(const TemporaryDirectory&) = delete;
    ~TemporaryDirectory() {
        std::error_code ignored;
        std::filesystem::remove_all(path, ignored);
    }

    std::string File(const std::string& name) const { return (path / name).string(); }
    std::string Bytes(const std::string& name) const { return ReadBytes(File(name)); }
    bool Has(const std::string& name) const { return std::filesystem::exists(path / name); }

    // Writes a file, with the directories that its name has, and returns its path.
    std::string Write(const std::string& name, std::string_view bytes) const {
        std::filesystem::create_directories((path / name).parent_path());
        // A new file, as some file systems wait for the disk when an old one is truncated.
        std::filesystem::remove(path / name);
        std::ofstream out(path / name, std::ios::binary);
        out.write(bytes.data(), std::streamsize(bytes.size()));
        out.close();
        if (!out) throw Error("cannot write " + File(name));
        return File(name);
    }

    // Returns a message without the directory's name.
    std::string WithoutPath(std::string message) const {
        const std::string prefix = path.string() + "/";
        for (size_t at; (at = message.find(prefix)) != std::string::npos;)
            message.erase(at, prefix.size());
        return message;
    }

    int CountFiles() const {
        return int(std::distance(std::filesystem::directory_iterator(path), {}));
    }
};

// Decodes pairs of hexadecimal digits, with or without blanks between them.
inline std::string FromHex(std::string_view hex) {
    std::string bytes;
    for (size_t i = 0; i + 1 < hex.size(); i += hex[i] == ' ' ? 1 : 2)
        if (hex[i] != ' ')
            bytes += char(std::strtol(std::string(hex.substr(i, 2)).c_str(), nullptr, 16));
    return bytes;
}

// Returns the message of an Error thrown by `call`; empty where none was thrown.
template <typename Call>
std::string ErrorOf(const Call& call) {
    try {
        call();
    } catch (const Error& error) {
        return error.what();
    }
    return "";
}

}  // namespace lull
