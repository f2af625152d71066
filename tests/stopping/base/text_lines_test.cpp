#include "stopping/base/text_lines.h"

#include <gtest/gtest.h>

#include <sstream>
#include <vector>

namespace lull {
namespace {

using namespace std::string_literals;

std::vector<std::string> LinesOf(const std::string& text) {
    std::istringstream in(text);
    std::vector<std::string> lines;
    for (TextLines read(in, "a.csv"); read.Next();) {
        lines.push_back(read.Line());
        EXPECT_EQ(read.Number(), int(lines.size()));
    }
    return lines;
}

TEST(TextLines, EndAsOnAllSystems) {
    const std::vector<std::string> expected = {"a", "", "b c"};
    for (const std::string& text : {"a\n\nb c"s, "a\n\nb c\n"s, "a\r\n\r\nb c\r\n"s, "a\r\rb c\r"s,
                                    "\xef\xbb\xbf"
                                    "a\n\nb c\n\x1a"s,
                                    "a\n\nb c\n\0"s, "a\n\nb c\x1amore\n"s})
        EXPECT_EQ(LinesOf(text), expected) << text;
    EXPECT_TRUE(LinesOf("").empty());
}

TEST(TextLines, RefuseUtf16) {
    for (const std::string& text : {"\xff\xfe"
                                    "a\0\n\0"s,
                                    "\xfe\xff\0a\0\n"s, "a\0b\0"s, "\0a\0b"s})
        try {
            LinesOf(text);
            ADD_FAILURE() << text;
        } catch (const std::runtime_error& error) {
            EXPECT_EQ(error.what(), "a.csv: the text is UTF-16; save it as UTF-8"s);
        }
}

}  // namespace
}  // namespace lull
