#include "stopping/base/state.h"

#include <gtest/gtest.h>

namespace lull {
namespace {

template <typename Call>
std::string ComplaintOf(const Call& call) {
    try {
        call();
    } catch (const std::runtime_error& error) {
        return error.what();
    }
    return "";
}

TEST(State, SaysWhatIsDamaged) {
    StateWriter writer;
    writer.Put(uint32_t(7));
    StateReader message(writer.bytes, "a message");
    EXPECT_EQ(ComplaintOf([&] { message.Get<uint64_t>(); }), "a message is cut short");
    EXPECT_EQ(ComplaintOf([&] { message.Finish(); }), "a message is longer than expected");
    EXPECT_EQ(ComplaintOf([&] { message.Expect(8); }), "a message is of another kind");
    EXPECT_EQ(ComplaintOf([&] { message.Finish(); }), "");
    EXPECT_EQ(ComplaintOf([&] { StateReader(writer.bytes).Get<uint64_t>(); }),
              "the saved state is cut short");
}

}  // namespace
}  // namespace lull
