#include "renderer/base/error.h"

#include <gtest/gtest.h>

namespace lull {
namespace {

TEST(Utf8, HasCharactersOfOneToFourBytes) {
    EXPECT_EQ(CharacterBytes("a"), 1u);
    EXPECT_EQ(CharacterBytes("\u00e9t\u00e9"), 2u);
    EXPECT_EQ(CharacterBytes("\u20ac"), 3u);
    EXPECT_EQ(CharacterBytes("\U0010ffff."), 4u);
    EXPECT_EQ(CharacterBytes(""), 0u);
}

TEST(Utf8, HasNoOverlongOnesNoSurrogatesAndNoParts) {
    for (const char* text :
         {"\x80", "\xc0\x80", "\xc1\xbf", "\xe0\x9f\xbf", "\xed\xa0\x80", "\xf0\x8f\xbf\xbf",
          "\xf4\x90\x80\x80", "\xf5\x80\x80\x80", "\xff", "\xc3", "\xe2\x82", "\xe2\x82z"})
        EXPECT_EQ(CharacterBytes(text), 0u);
    EXPECT_EQ(ToUtf8("a\xe2\x82z\u20ac\xff"), "a\ufffd\ufffdz\u20ac\ufffd");
    EXPECT_EQ(ToUtf8(std::string_view("a\0b", 3)), "a\ufffdb");
}

TEST(Utf8, IsCutBetweenCharacters) {
    EXPECT_EQ(BeginningOf("a\u20acb", 5), "a\u20acb");
    EXPECT_EQ(BeginningOf("a\u20acb", 4), "a\u20ac");
    EXPECT_EQ(BeginningOf("a\u20acb", 3), "a");
    EXPECT_EQ(BeginningOf("\u20ac", 2), "");
}

}  // namespace
}  // namespace lull
