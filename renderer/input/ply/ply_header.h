// Reads the headers of PLY files.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "renderer/base/error.h"

namespace lull {

enum class PlyFormat { Ascii, LittleEndian, BigEndian };

enum class PlyType { Int8, Uint8, Int16, Uint16, Int32, Uint32, Float32, Float64 };

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
        case PlyType::Float32:
            return use(float());
        default:
            return use(double());
    }
}

// Returns the bytes of a value in binary files.
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

}  // namespace lull
