// Reads the values in PLY data one by one.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstring>
#include <string_view>
#include <utility>

#include "renderer/base/error.h"
#include "renderer/files/file_contents.h"
#include "renderer/input/ply/ply_header.h"

namespace lull {

// Returns the value of type T at `bytes`, in the other byte order if `swap`.
template <typename T>
T LoadPlyValue(const char* bytes, bool swap) {
    std::array<char, sizeof(T)> copy;
    std::memcpy(copy.data(), bytes, sizeof(T));
    if (swap) std::ranges::reverse(copy);
    return std::bit_cast<T>(copy);
}

// Walks through the data; knows the line in ASCII files. Reading past the end throws Error.
struct PlyCursor {
    const char* pos;
    const char* end;
    PlyFormat format;
    FileLoc loc;

    size_t Remaining() const { return size_t(end - pos); }

    [[noreturn]] void FailTruncated() const {
        throw Error(loc, "the PLY file ends before all its elements");
    }

    const char* Skip(size_t bytes) {
        if (Remaining() < bytes) FailTruncated();
        return std::exchange(pos, pos + bytes);
    }

    std::string_view Word() {
        const auto isSpace = [](char c) { return c == ' ' || (c >= '\t' && c <= '\r'); };
        for (; pos < end && isSpace(*pos); ++pos)
            if (*pos == '\n' || (*pos == '\r' && (pos + 1 == end || pos[1] != '\n'))) ++loc.line;
        if (pos == end) FailTruncated();
        const char* const begin = pos;
        while (pos < end && !isSpace(*pos)) ++pos;
        return {begin, size_t(pos - begin)};
    }

    // Reads a value. In double every type keeps its exact value. In ASCII files NaN and infinity
    // pass as such.
    double Read(PlyType type) {
        if (format == PlyFormat::Ascii) {
            std::string_view word = Word();
            const std::string_view text = word.starts_with('+') ? word.substr(1) : word;
            double value = 0;
            const auto [stop, status] =
                std::from_chars(text.data(), text.data() + text.size(), value);
            if (status != std::errc() || stop != text.data() + text.size())
                throw Error(loc, "'" + Printable(word) + "' is not a number that can be used");
            return value;
        }
        const bool swap = format == PlyFormat::BigEndian;
        const char* const bytes = Skip(PlyTypeSize(type));
        return WithTypeOf(type,
                          [&](auto t) { return double(LoadPlyValue<decltype(t)>(bytes, swap)); });
    }

    // Reads the count of a list: at least 0 and no more than the values that can follow.
    size_t ReadListCount(const PlyProperty& list) {
        const double count = Read(list.countType);
        if (!(count >= 0) || count != std::floor(count))
            throw Error(loc, "a list of property '" + Printable(list.name) +
                                 "' has a count that is negative or no integer");
        const size_t bytes = format == PlyFormat::Ascii ? 1 : PlyTypeSize(list.type);
        if (count > double(Remaining() / bytes)) FailTruncated();
        return size_t(count);
    }

    void SkipProperty(const PlyProperty& property) {
        const size_t count = property.isList ? ReadListCount(property) : 1;
        if (format != PlyFormat::Ascii)
            Skip(count * PlyTypeSize(property.type));
        else
            for (size_t i = 0; i < count; ++i) Word();
    }
};

}  // namespace lull
