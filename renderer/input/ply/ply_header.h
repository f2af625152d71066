// Reads the headers and values of PLY files, and divides their polygons.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "renderer/base/error.h"
#include "renderer/base/math.h"
#include "renderer/files/file_io.h"

namespace lull {

enum class PlyFormat { Ascii, LittleEndian, BigEndian };

enum class PlyType { Int8, Uint8, Int16, Uint16, Int32, Uint32, Int64, Uint64, Float32, Float64 };

// Returns use(T()), where T is the C++ type of such values in binary files.
template <typename Use>
auto WithTypeOf(PlyType type, const Use& use) {
    switch (type) {
        case PlyType::Int8:
            return use(int8_t());
        case PlyType::Uint8:
            return use(uint8_t());
        case PlyType::Int16:
            return use(int16_t());
        case PlyType::Uint16:
            return use(uint16_t());
        case PlyType::Int32:
            return use(int32_t());
        case PlyType::Uint32:
            return use(uint32_t());
        case PlyType::Int64:
            return use(int64_t());
        case PlyType::Uint64:
            return use(uint64_t());
        case PlyType::Float32:
            return use(float());
        default:
            return use(double());
    }
}

inline int PlyTypeSize(PlyType type) {
    return WithTypeOf(type, [](auto value) { return int(sizeof(value)); });
}

struct PlyProperty {
    std::string name;
    PlyType type;
    bool isList = false;
    PlyType countType = PlyType::Uint8;  // of a list, always an integer
};

struct PlyElement {
    std::string name;
    int64_t count = 0;  // not yet compared with the data: may be anything up to 2^63 - 1
    std::vector<PlyProperty> properties;
};

struct PlyHeader {
    PlyFormat format = PlyFormat::Ascii;
    std::vector<PlyElement> elements;
    size_t bytes = 0;  // where the data starts
    int lines = 0;
};

// Parses the header at the beginning of `file`, whose name is in `loc`. Lines end in LF, CR LF or,
// where the first one does, CR. Throws Error with the line of whatever is wrong.
PlyHeader ParsePlyHeader(std::string_view file, FileLoc loc);

// Reads the values in PLY data one by one.

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

    // Reads a value. In double every type but 64-bit integers keeps its exact value. In ASCII files
    // NaN and infinity pass as such.
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

// Divides polygons into triangles.

inline constexpr size_t kMostPolygonCorners = 256;

// Returns the triangles of a simple polygon of 3 to kMostPolygonCorners corners, by the numbers of
// its corners. Where it is convex, those of a fan about the first, as in pbrt-v3's quads; so it is
// where `positions` lacks one of its vertices.
std::vector<std::array<size_t, 3>> TrianglesOf(std::span<const uint32_t> vertices,
                                               std::span<const Vec3f> positions);

}  // namespace lull
