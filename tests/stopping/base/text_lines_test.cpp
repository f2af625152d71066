#include "stopping/base/text_lines.h"

#include <gtest/gtest.h>

#include <sstream>
#include <stdexcept>
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
                                    "a\n\nb c\n\0"s, "a\n\nb c\x1a\0\r\n\0"s})
        EXPECT_EQ(LinesOf(text), expected) << text;
    EXPECT_TRUE(LinesOf("").empty());
}

std::string MessageOf(const std::string& text) {
    try {
        LinesOf(text);
    } catch (const std::runtime_error& error) {
        return error.what();
    }
    return "";
}

TEST(TextLines, RefuseOtherEncodings) {
    for (const std::string& text : {"\xff\xfe"
                                    "a\0\n\0"s,
                                    "\xfe\xff\0a\0\n"s, "a\0;\0001\0;\0"s, "\0a\0;\0001\0;"s})
        EXPECT_EQ(MessageOf(text), "a.csv: the text is UTF-16; save it as UTF-8");
    EXPECT_EQ(MessageOf("\xff\xfe\0\0a\0\0\0"s), "a.csv: the text is UTF-32; save it as UTF-8");
}

// Once, all behind the mark was left out without a word.
TEST(TextLines, RefuseMarksOfTheEndAmidTheText) {
    for (const std::string& text : {"a\nb\x1a\nc"s, "a\r\nb\0c"s, "a\r\x1a\rc\r"s})
        EXPECT_TRUE(MessageOf(text).starts_with("a.csv:2: Control-Z or NUL")) << MessageOf(text);
}

}  // namespace
}  // namespace lull
