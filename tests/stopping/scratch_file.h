// Gives tests a file name of their own and removes the file afterwards, and catches exceptions.
#pragma once

#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <span>
#include <stdexcept>
#include <string>

#include "tests/expect_has.h"

namespace lull {

class ScratchFile {
  public:
    explicit ScratchFile(const std::string& suffix) {
        static int count = 0;
        path = (std::filesystem::temp_directory_path() /
                ("lull-" + std::to_string(getpid()) + "-" + std::to_string(count++) + suffix))
                   .string();
    }
    ScratchFile(const std::string& suffix, const std::string& text) : ScratchFile(suffix) {
        std::ofstream(path) << text;
    }
    ~ScratchFile() { std::filesystem::remove(path); }
    ScratchFile(const ScratchFile&) = delete;
    ScratchFile& operator=(const ScratchFile&) = delete;

    std::string path;
};

inline std::string ContentsOf(const std::string& path) {
    std::ifstream in(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
}

inline void WriteBytes(const std::string& path, std::span<const std::byte> bytes) {
    std::ofstream(path, std::ios::binary)
        .write(reinterpret_cast<const char*>(bytes.data()), std::streamsize(bytes.size()));
}

// Returns the message of an exception of this type thrown by `call`; empty where none was thrown.
template <typename Exception = std::runtime_error, typename Call>
std::string WhatOf(const Call& call) {
    try {
        call();
    } catch (const Exception& error) {
        return error.what();
    }
    return "";
}

}  // namespace lull
