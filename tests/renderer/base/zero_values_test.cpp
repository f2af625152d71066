#include "renderer/base/memory.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

namespace lull {
namespace {

using Zeros = std::vector<float, ZeroAllocator<float>>;

TEST(ZeroAllocator, BeginsWithZerosAndCopiesValues) {
    const auto isZero = [](float v) { return v == 0; };
    for (const size_t count : {size_t(7), size_t(10'000'000)}) {
        Zeros dirty(count);
        EXPECT_TRUE(std::ranges::all_of(dirty, isZero));
        std::ranges::fill(dirty, 3.f);
        const Zeros copy = dirty;
        dirty = {};
        EXPECT_TRUE(std::ranges::all_of(Zeros(count), isZero));
        EXPECT_EQ(copy, Zeros(count, 3.f));
    }
}

TEST(ForgetValues, LeavesWhatIsBeside) {
    Zeros values(1 << 16, 5.f);
    ForgetValues({});
    ForgetValues(std::as_bytes(std::span(values).subspan(10, 3)));
    EXPECT_EQ(values[11], 5);  // less than a page
    ForgetValues(std::as_bytes(std::span(values).subspan(100, 50'000)));
    EXPECT_TRUE(std::all_of(values.begin(), values.begin() + 100, [](float v) { return v == 5; }));
    EXPECT_TRUE(std::all_of(values.begin() + 50'100, values.end(), [](float v) { return v == 5; }));
    std::ranges::fill(values, 7.f);
    EXPECT_EQ(values[20'000], 7);
}

}  // namespace
}  // namespace lull
