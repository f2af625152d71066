#include "stopping/base/input_file.h"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <iterator>
#include <sstream>
#include <stdexcept>
#include <vector>

#include "tests/stopping/scratch_file.h"

namespace lull {
namespace {

TEST(OpenInput, ReadsRegularFilesAlone) {
    const ScratchFile text(".txt", "a\r\nb"), fifo(".fifo"), missing(".txt");
    std::ifstream file = OpenInput(text.path);
    EXPECT_EQ(std::string(std::istreambuf_iterator<char>(file), {}), "a\r\nb");
    ASSERT_EQ(mkfifo(fifo.path.c_str(), 0600), 0);
    EXPECT_EQ(WhatOf([&] { OpenInput(fifo.path); }), fifo.path + ": it is not a regular file");
    EXPECT_EQ(WhatOf([&] { OpenInput(missing.path); }),
              missing.path + ": No such file or directory");
    EXPECT_EQ(WhatOf([&] { OpenInput("/dev/zero"); }), "/dev/zero: it is not a regular file");
    EXPECT_EQ(WhatOf([&] { OpenInput("/"); }), "/: it is a directory; name a file in it");
    EXPECT_NE(ReasonNotToRead(std::string("a\0b", 3)), "");
}

TEST(IsThere, TellsWhyItCannotTell) {
    const ScratchFile text(".txt", "a"), missing(".txt");
    EXPECT_TRUE(IsThere(text.path));
    EXPECT_TRUE(IsThere("/"));
    EXPECT_FALSE(IsThere(missing.path));
    EXPECT_FALSE(IsThere(text.path + "/of-a-file"));
    const std::string tooLong(300, 'x');
    EXPECT_EQ(WhatOf([&] { IsThere(tooLong); }), tooLong + ": File name too long");
}

TEST(Printable, QuotesBrieflyAndWithoutControl) {
    EXPECT_EQ(Printable("a \x1b[31m\a"), "a \\x1b[31m\\x07");
    EXPECT_EQ(Printable(std::string("\0\x7f\xc3", 3)), "\\x00\\x7f\\xc3");
    EXPECT_EQ(Printable(std::string(60, 'a')), std::string(60, 'a'));
    EXPECT_EQ(Printable(std::string(10'000'074, 'a')), std::string(60, 'a') + "...");
    EXPECT_EQ(Printable("abcdef", 3), "abc...");
}

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
    return WhatOf([&] { LinesOf(text); });
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

std::string Problem(const std::string& text) {
    const ScratchFile file(".sealed", text);
    return WhatOf([&] { CheckSeal(file.path); });
}

std::string Sealed(const std::string& text) {
    const auto bytes = std::as_bytes(std::span(text));
    std::vector<std::byte> sealed(bytes.begin(), bytes.end());
    Seal(&sealed);
    return {reinterpret_cast<const char*>(sealed.data()), sealed.size()};
}

TEST(Seal, FindsEveryFlippedBit) {
    for (const std::string& text : {std::string(), std::string(100, 'x')}) {
        const std::string good = Sealed(text);
        EXPECT_EQ(Problem(good), "");
        const auto content = CheckSeal(std::as_bytes(std::span(good)));
        EXPECT_EQ(std::string(reinterpret_cast<const char*>(content.data()), content.size()), text);
        for (size_t bit = 0; bit < 8 * good.size(); ++bit) {
            std::string bad = good;
            bad[bit / 8] ^= char(1 << bit % 8);
            EXPECT_NE(Problem(bad), "") << bit;
            EXPECT_THROW(CheckSeal(std::as_bytes(std::span(bad))), std::runtime_error) << bit;
        }
        for (size_t size = 0; size < good.size(); ++size)
            EXPECT_NE(Problem(good.substr(0, size)), "") << size;
        EXPECT_NE(Problem(good + "x"), "");
    }
}

TEST(Seal, SaysWhatIsWrong) {
    std::string bad = Sealed(std::string(100, 'x'));
    bad[50] = 'y';
    EXPECT_HAS(Problem(bad), "damaged");
    EXPECT_HAS(Problem("something else"), "cut short");
    EXPECT_HAS(WhatOf([] { CheckSeal("/nowhere/x.h5"); }), "No such file");
}

}  // namespace
}  // namespace lull
