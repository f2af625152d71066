#include "stopping/base/input_file.h"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <iterator>
#include <stdexcept>

#include "tests/stopping/scratch_file.h"
#include "tests/stopping/what_of.h"

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

}  // namespace
}  // namespace lull
