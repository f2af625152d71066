// Images as their files store them.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <variant>
#include <vector>
#ifdef __F16C__
#include <immintrin.h>
#endif

#include "renderer/base/math.h"

namespace lull {

// A 16-bit IEEE 754 float. Eigen 3.4 converts Eigen::half in software by GCC.
struct Half {
    uint16_t bits = 0;

    Half() = default;
    // Eigen::half's own member is a number since Eigen 5, no longer the bits.
    explicit Half(float v) : bits(Eigen::numext::bit_cast<uint16_t>(Eigen::half(v))) {}
    explicit operator float() const {
#ifdef __F16C__
        return _cvtsh_ss(bits);
#else
        return float(Eigen::numext::bit_cast<Eigen::half>(bits));
#endif
    }
    bool operator==(const Half&) const = default;
};

// An image in its native form: rows from the top, channels interleaved. 8-bit texels stand
// for 0 to 1 in whatever encoding the file has; half and float are as read.
struct Image {
    int width = 0, height = 0;
    int channels = 0;  // 1: grey; 2: grey, alpha; 3: RGB; 4: RGB, unassociated alpha
    std::variant<std::vector<uint8_t>, std::vector<Half>, std::vector<float>> texels;

    size_t Bytes() const {
        return std::visit([](const auto& t) { return t.size() * sizeof(t[0]); }, texels);
    }
};

}  // namespace lull
