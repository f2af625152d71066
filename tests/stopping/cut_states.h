// Damages saved states.
#pragma once

#include <gtest/gtest.h>

#include <cstddef>
#include <span>
#include <stdexcept>
#include <vector>

namespace lull {

// Checks that restore(state) throws for every `step`-th shorter part of a state.
template <typename Restore>
void ExpectRefusesCut(std::span<const std::byte> state, size_t step, const Restore& restore) {
    ASSERT_FALSE(state.empty());
    for (size_t size = 0; size < state.size(); size += step)
        EXPECT_THROW(restore(state.first(size)), std::runtime_error) << size;
}

}  // namespace lull
