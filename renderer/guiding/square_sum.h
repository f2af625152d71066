// Sums squares of samples in fixed point: the same in any order, so that any number of threads may
// add at the same time.
#pragma once

#include <algorithm>
#include <atomic>
#include <cstdint>

#include "renderer/base/math.h"

namespace lull {

struct SquareSum {
    static constexpr float kScale = 0x1p20f;

    // Adds a sample, whose square counts as at most `largest`; one that is not positive, and NaN,
    // counts as 0.
    void Add(float value, float largest) {
        std::atomic_ref(count).fetch_add(1, std::memory_order_relaxed);
        if (!(value > 0)) return;
        const float square = std::min(Sqr(value), largest);
        std::atomic_ref(squares).fetch_add(uint64_t(square * kScale + 0.5f),
                                           std::memory_order_relaxed);
    }
    float Squares() const { return float(squares) / kScale; }
    bool operator==(const SquareSum&) const = default;

    uint64_t squares = 0;  // in units of 1 / kScale
    uint64_t count = 0;
};

}  // namespace lull
