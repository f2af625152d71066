#include "stopping/base/state.h"

#include <gtest/gtest.h>

#include "tests/stopping/scratch_file.h"

namespace lull {
namespace {

TEST(State, SaysWhatIsDamaged) {
    StateWriter writer;
    writer.Put(uint32_t(7));
    StateReader message(writer.bytes, "a message");
    EXPECT_EQ(WhatOf([&] { message.Get<uint64_t>(); }), "a message is cut short");
    EXPECT_EQ(WhatOf([&] { message.Finish(); }), "a message is longer than expected");
    EXPECT_EQ(WhatOf([&] { message.Expect(8); }), "a message is of another kind");
    EXPECT_EQ(WhatOf([&] { message.Finish(); }), "");
    EXPECT_EQ(WhatOf([&] { StateReader(writer.bytes).Get<uint64_t>(); }),
              "the saved state is cut short");
    EXPECT_EQ(int(StateReader(writer.bytes).Get<bool>()), 1);
}

}  // namespace
}  // namespace lull
