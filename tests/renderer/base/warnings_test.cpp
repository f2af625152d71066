// Tests what is passed on of many warnings and errors.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "renderer/base/error.h"

namespace lull::warnings_test {

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

}  // namespace lull::warnings_test
