#include "renderer/base/error.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <thread>

namespace lull::error_test {

struct Heard {
    std::vector<std::string> messages;
    Warnings warnings;

    explicit Heard(bool substitutes = false, bool isVerbose = false)
        : warnings([this](const std::string& m) { messages.push_back(m); }, substitutes,
                   isVerbose) {}
};

FileLoc Line(int line) { return {std::make_shared<const std::string>("a.pbrt"), line}; }

// Returns the message that the errors kept so far give, "" for none.
std::string MessageOf(Warnings* warnings) {
    try {
        warnings->ThrowErrors();
    } catch (const Error& error) {
        return error.what();
    }
    return "";
}

TEST(Warnings, OfAKindAreToldOnceAndCounted) {
    Heard heard;
    for (int i = 1; i <= 3; ++i) heard.warnings.Add(Line(i), "odd", "very");
    EXPECT_EQ(heard.messages, std::vector<std::string>{"a.pbrt:1: warning: odd: very"});
    heard.warnings.Summarize();
    EXPECT_EQ(heard.messages.back(), "warning: odd (3 times in all)");
}

TEST(Warnings, ThatDifferInWhatTheyQuoteAreToldTenTimes) {
    Heard heard(true);
    for (int i = 0; i < 20000; ++i)
        heard.warnings.Substitute(Line(i + 1), fmt::format("material \"m{}\" is pbrt-v3's", i),
                                  "matte stands in");
    heard.warnings.Add({}, "another");
    EXPECT_EQ(heard.messages.size(), 11u);
    heard.warnings.Summarize();
    ASSERT_EQ(heard.messages.size(), 12u);
    EXPECT_EQ(heard.messages.back(),
              "warning: and 19990 more: material \"...\" is pbrt-v3's; matte stands in");
    EXPECT_EQ(heard.warnings.Counts().size(), 20001u);
    EXPECT_EQ(MessageOf(&heard.warnings), "");
}

TEST(Warnings, OfLittleConsequenceAreCountedAndToldIfAskedFor) {
    for (const bool isVerbose : {false, true}) {
        Heard heard(false, isVerbose);
        heard.warnings.AddMinor(Line(1), "thin");
        heard.warnings.AddMinor(Line(2), "thin");
        heard.warnings.Summarize();
        EXPECT_EQ(heard.messages.size(), isVerbose ? 2u : 0u);
        EXPECT_EQ(heard.warnings.Total(), 2);
    }
}

TEST(Warnings, WithoutSubstitutesAreErrorsThatNameThem) {
    Heard heard;
    heard.warnings.Substitute(Error(Line(7), "there is no 'x'"), "y stands in");
    EXPECT_TRUE(heard.messages.empty());
    EXPECT_EQ(MessageOf(&heard.warnings),
              "a.pbrt:7: there is no 'x'; with --substitute y stands in");
    EXPECT_EQ(MessageOf(&heard.warnings), "");
}

TEST(Warnings, ThrowTenErrorsAndTheNumberOfTheOthers) {
    Heard heard;
    for (int i = 1; i <= 25; ++i)
        EXPECT_FALSE(heard.warnings.Try([&] { throw Error(Line(i), "bad"); }));
    EXPECT_TRUE(heard.warnings.Try([] {}));
    const std::string message = MessageOf(&heard.warnings);
    EXPECT_TRUE(message.starts_with("a.pbrt:1: bad\na.pbrt:2: bad\n")) << message;
    EXPECT_TRUE(message.ends_with("\na.pbrt:10: bad\nand 15 more")) << message;
}

TEST(Warnings, CountsFromManyThreads) {
    int shown = 0;
    Warnings warnings([&](const std::string&) { ++shown; });
    {
        std::vector<std::jthread> threads;
        for (int t = 0; t < 4; ++t)
            threads.emplace_back([&] {
                for (int i = 0; i < 1000; ++i) warnings.Add({}, i % 2 ? "odd" : "even");
            });
    }
    EXPECT_EQ(shown, 2);
    EXPECT_EQ(warnings.Counts(), (std::map<std::string, int>{{"even", 2000}, {"odd", 2000}}));
}

TEST(FileLoc, FormatsItsPrefix) {
    EXPECT_EQ(Line(7).Prefix(), "a.pbrt:7: ");
    EXPECT_EQ(Line(0).Prefix(), "a.pbrt: ");
    EXPECT_EQ(FileLoc().Prefix(), "");
    EXPECT_STREQ(Error(Line(7), "broken").what(), "a.pbrt:7: broken");
}

TEST(OneLine, JoinsWhatLibrariesSayInSeveral) {
    EXPECT_EQ(OneLine("one"), "one");
    EXPECT_EQ(OneLine("one\ntwo\r\n\nthree\n"), "one; two; three");
    EXPECT_EQ(OneLine("\n"), "");
    EXPECT_EQ(OneLine("abcdefgh", 8), "abcdefgh");
    EXPECT_EQ(OneLine("abcdefghi", 4), "ab ... hi");
    EXPECT_EQ(OneLine("\u00e4\u00e4\u00e4\u00e4", 6), "\u00e4 ... \u00e4");  // no half characters
}

TEST(OneLine, EscapesWhatNoTerminalPrints) {
    EXPECT_EQ(OneLine("a\x1b\x7f"), "a\\x1b\\x7f");
    EXPECT_EQ(OneLine("\u00e4\u20ac\U0001f600"), "\u00e4\u20ac\U0001f600");
    EXPECT_EQ(OneLine("a\xe4 b"), "a\\xe4 b");              // Latin-1
    EXPECT_EQ(OneLine("\xe2\x82"), "\\xe2\\x82");           // cut short
    EXPECT_EQ(OneLine("\xc2"), "\\xc2");                    // its second byte is missing
    EXPECT_EQ(OneLine("\xc2\x9b"), "\\xc2\\x9b");           // a control character
    EXPECT_EQ(OneLine("\xc0\xaf"), "\\xc0\\xaf");           // too long for its character
    EXPECT_EQ(OneLine("\xed\xa0\x80"), "\\xed\\xa0\\x80");  // half of a pair
    EXPECT_EQ(OneLine("\xff\xfe"), "\\xff\\xfe");
}

TEST(PrintToStderr, GoesOnWhereNothingCanBeWritten) {
    std::FILE* full = std::fopen("/dev/full", "w");
    if (!full) GTEST_SKIP() << "there is no /dev/full";
    std::setbuf(full, nullptr);
    EXPECT_NO_THROW(PrintTo(full, "{} of {}\n", 1, 2));
    EXPECT_TRUE(std::ferror(full));
    std::fclose(full);
}

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

}  // namespace lull::error_test
