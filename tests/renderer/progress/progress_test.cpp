#include "renderer/progress/progress.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <memory>

#include "tests/renderer/files/test_files.h"

namespace lull {
namespace {

RenderProgress Halfway() {
    return {.blocks = 16,
            .stoppedBlocks = 9,
            .medianSpp = 1240,
            .samples = 5000000,
            .samplesToCap = 5000000,
            .seconds = 100};
}

ProgressState StateOf(const RenderProgress& p, double rate = 50000, bool adaptive = true) {
    return {p, ShareDone(p), rate, adaptive};
}

// Returns what a printer writes.
template <typename Use>
std::string Printed(ProgressStyle style, const Use& use) {
    const TemporaryDirectory directory;
    const std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(
        std::fopen(directory.File("out").c_str(), "w"), std::fclose);
    ProgressPrinter printer(style, false, file.get());
    use(printer);
    return directory.Bytes("out");
}

TEST(FormatDuration, IsShortAtEveryScale) {
    EXPECT_EQ(FormatDuration(0), "0.0s");
    EXPECT_EQ(FormatDuration(12.34), "12.3s");
    EXPECT_EQ(FormatDuration(59.96), "1:00");
    EXPECT_EQ(FormatDuration(245), "4:05");
    EXPECT_EQ(FormatDuration(3599.6), "1:00:00");
    EXPECT_EQ(FormatDuration(360000), "100:00:00");
    EXPECT_EQ(FormatDuration(-1), "0.0s");
    EXPECT_EQ(FormatDuration(std::numeric_limits<double>::quiet_NaN()), "0.0s");
}

TEST(FormatCount, KeepsThreeDigits) {
    EXPECT_EQ(FormatCount(0), "0");
    EXPECT_EQ(FormatCount(999), "999");
    EXPECT_EQ(FormatCount(1234), "1.23 k");
    EXPECT_EQ(FormatCount(12345), "12.3 k");
    EXPECT_EQ(FormatCount(123456), "123 k");
    EXPECT_EQ(FormatCount(999600), "1.00 M");
    EXPECT_EQ(FormatCount(6.4e9), "6.40 G");
}

TEST(ProgressText, TellsTheTimeToTheCapFromAForecast) {
    const std::string adaptive = ProgressText(StateOf(Halfway()));
    EXPECT_EQ(adaptive,
              " 50%  9/16 blocks done  median 1240 spp  50.0 k samples/s  1:40 elapsed  "
              "1:40 to the cap");
    EXPECT_TRUE(ProgressText(StateOf(Halfway(), 50000, false)).ends_with("  1:40 left"));
}

TEST(ProgressText, PredictsTheEndWhereItCan) {
    RenderProgress progress = Halfway();
    progress.predictedSamples = 1250000;
    progress.predictedSeconds = 30;
    EXPECT_EQ(ProgressText(StateOf(progress)),
              " 80%  9/16 blocks done  median 1240 spp  50.0 k samples/s  1:40 elapsed  "
              "about 30.0s left");
    EXPECT_HAS(ProgressJson(StateOf(progress)),
               R"("remainingSeconds":30.000,"remainingRange":null,"remainingIsUpperBound":false)");
    // A clock can end it before.
    progress.secondsLeft = 12;
    EXPECT_HAS(ProgressText(StateOf(progress)), "at most 12.0s left");
    // Nothing is left when all have stopped.
    progress.samplesToCap = 0;
    progress.predictedSamples = 0;
    EXPECT_TRUE(ProgressText(StateOf(progress)).starts_with("100%"));
    EXPECT_FALSE(Contains(ProgressText(StateOf(progress)), "left"));
}

// What holds for the cap says nothing before a block has stopped.
TEST(ProgressText, HasNoTimeBeforeThereAreData) {
    RenderProgress progress = Halfway();
    progress.stoppedBlocks = 0;
    EXPECT_TRUE(ProgressText(StateOf(progress)).ends_with("1:40 elapsed"));
    EXPECT_HAS(ProgressJson(StateOf(progress)), R"("remainingSeconds":null,"remainingRange":null)");
    EXPECT_TRUE(ProgressText(StateOf(progress, 50000, false)).ends_with("  1:40 left"));
    progress.secondsLeft = 500;
    EXPECT_TRUE(ProgressText(StateOf(progress)).ends_with("at most 8:20 left"));
}

TEST(ProgressText, HasARangeOfTimes) {
    RenderProgress progress = Halfway();
    progress.predictedSamples = 1250000;
    progress.predictedSeconds = 650;
    progress.secondsRange = {{550, 830}};
    EXPECT_TRUE(ProgressText(StateOf(progress)).ends_with("  done in 9 to 14 min (80 %)"));
    EXPECT_HAS(ProgressJson(StateOf(progress)),
               R"("remainingSeconds":650.000,"remainingRange":[550.000,830.000])");
    progress.secondsLeft = 700;  // of a clock that ends it within the range
    EXPECT_TRUE(ProgressText(StateOf(progress)).ends_with("  done in 9 to 12 min (80 %)"));
}

TEST(FormatRange, IsRoundedOutwards) {
    EXPECT_EQ(FormatRange({0, 0.2}), "0 to 1 s");
    EXPECT_EQ(FormatRange({61.5, 119.5}), "61 to 120 s");
    EXPECT_EQ(FormatRange({90, 310}), "1 to 6 min");
    EXPECT_EQ(FormatRange({4000, 8000}), "66 to 134 min");
    EXPECT_EQ(FormatRange({10000, 20000}), "2 to 6 h");
}

TEST(ProgressText, GuessesNothingWithoutARate) {
    EXPECT_FALSE(Contains(ProgressText(StateOf(Halfway(), 0, true)), "left"));
    EXPECT_HAS(ProgressText(StateOf({}, 0, true)), "100%");
}

TEST(ProgressJson, IsOneLineOfJson) {
    EXPECT_EQ(
        ProgressJson(StateOf(Halfway())),
        R"({"event":"progress","percent":50.00,"blocks":16,"cleanBlocks":9,)"
        R"("blocksAtCap":0,"medianSpp":1240,"samples":5000000,"samplesPerSecond":50000.0,"elapsedSeconds":100.000,)"
        R"("remainingSeconds":100.000,"remainingRange":null,"remainingIsUpperBound":true})");
    EXPECT_HAS(ProgressJson(StateOf(Halfway(), 0, true)), R"("remainingSeconds":null)");
}

// Of a long render, where numbers are as long as they get.
TEST(ProgressText, FitsTheTerminal) {
    RenderProgress long_ = Halfway();
    long_.blocks = 1200;
    long_.stoppedBlocks = 1150;
    long_.seconds = 360000;
    long_.predictedSeconds = 400000;
    const ProgressState state = StateOf(long_, 123456789, true);
    EXPECT_GT(ProgressText(state).size(), 80u);
    for (int columns = 1; columns <= 120; ++columns) {
        const std::string text = ProgressText(state, columns);
        EXPECT_LE(int(text.size()), columns);
        EXPECT_TRUE(text.starts_with(std::string(" 50%").substr(0, size_t(columns)))) << text;
    }
    EXPECT_EQ(ProgressText(state, 79),
              " 50%  1150/1200 blocks  1240 spp  123 M/s  100:00:00  about 111:06:40 left");
    EXPECT_EQ(ProgressText(state, 59), " 50%  1150/1200 blocks  100:00:00  about 111:06:40 left");
}

// The blocks that are left over are the slow ones: an average over the whole run would promise
// far too early an end.
TEST(RateMeter, ForgetsWhatIsLongPast) {
    RateMeter rate;
    EXPECT_EQ(rate.SamplesPerSecond(), 0);
    int64_t samples = 0;
    for (int second = 1; second <= 100; ++second)
        rate.Add({.samples = samples += 1000, .seconds = double(second)});
    EXPECT_NEAR(rate.SamplesPerSecond(), 1000, 1e-6);
    for (int second = 101; second <= 140; ++second)
        rate.Add({.samples = samples += 10, .seconds = double(second)});
    EXPECT_NEAR(rate.SamplesPerSecond(), 10, 1e-6);
}

TEST(ProgressPrinter, RewritesOneLineOnATerminal) {
    const std::string text = Printed(ProgressStyle::Line, [](ProgressPrinter& printer) {
        printer.Print(Halfway());
        printer.Finish({.samples = 10000000, .seconds = 200});
    });
    EXPECT_EQ(std::count(text.begin(), text.end(), '\r'), 2);
    EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 1);
    EXPECT_EQ(text.back(), '\n');
}

TEST(ProgressPrinter, WritesPlainLinesEveryThirtySecondsWithoutControlCodes) {
    const std::string text = Printed(ProgressStyle::Plain, [](ProgressPrinter& printer) {
        for (int tenth = 1; tenth <= 1000; ++tenth)
            printer.Print({.samples = tenth, .samplesToCap = 1, .seconds = tenth / 10.0});
        printer.Finish({.samples = 1001, .seconds = 100.1});
    });
    EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 4);  // at 30, 60, 90 and the end
    EXPECT_FALSE(Contains(text, "\r"));
    EXPECT_FALSE(Contains(text, "\x1b"));
}

// Of a render that takes long, and of no other.
TEST(ProgressPrinter, WritesItsFirstForecastAtOnce) {
    for (const double most : {20., 200.}) {
        const std::string text = Printed(ProgressStyle::Plain, [&](ProgressPrinter& printer) {
            for (int second = 1; second <= 20; ++second) {
                RenderProgress progress{.samples = second, .samplesToCap = 1};
                progress.seconds = second;
                if (second > 5) progress.secondsRange = {{10, most}};
                printer.Print(progress);
            }
        });
        EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), most > 30 ? 1 : 0);
    }
}

// What is predicted may grow, and the last state may have been printed as it came.
TEST(ProgressPrinter, NeverFallsAndEndsOnce) {
    const std::string text = Printed(ProgressStyle::Json, [](ProgressPrinter& printer) {
        RenderProgress progress = Halfway();
        for (const double predicted : {5e6, 20e6, 2e6}) {
            progress.predictedSamples = predicted;
            printer.Print(progress);
        }
        printer.Finish(progress);
    });
    std::vector<std::string> percents;
    for (size_t at = 0; (at = text.find("percent\":", at)) != std::string::npos; ++at)
        percents.push_back(text.substr(at + 9, 5));
    EXPECT_EQ(percents, (std::vector<std::string>{"50.00", "50.00", "71.43"}));
}

TEST(ProgressPrinter, CanBeSilent) {
    EXPECT_EQ(Printed(ProgressStyle::Silent,
                      [](ProgressPrinter& printer) {
                          printer.Print(Halfway());
                          printer.Finish(Halfway());
                      }),
              "");
}

TEST(StepText, HasTheTimeThatIsLeft) {
    EXPECT_EQ(StepText("denoising", 0.25, 100), " 25%  denoising  1:40 elapsed  about 5:00 left");
    EXPECT_EQ(StepText("denoising", 0, 3), "  0%  denoising  3.0s elapsed");
}

TEST(StepJson, IsOneObject) {
    EXPECT_EQ(StepJson("denoising", 0.5, 8),
              R"({"event":"step","name":"denoising","percent":50.00,"elapsedSeconds":8.000,)"
              R"("remainingSeconds":8.000})");
    EXPECT_TRUE(StepJson("denoising", 0, 8).ends_with(R"("remainingSeconds":null})"));
}

TEST(StepPrinter, IsSilentAboutShortSteps) {
    const TemporaryDirectory directory;
    const std::string name = directory.File("out");
    const std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(std::fopen(name.c_str(), "w"),
                                                               std::fclose);
    StepPrinter("denoising", ProgressStyle::Line, file.get()).Print(0.5);
    std::fflush(file.get());
    EXPECT_EQ(ReadBytes(name), "");
}

}  // namespace
}  // namespace lull
