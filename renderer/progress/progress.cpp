#include "renderer/progress/progress.h"

#include <fmt/format.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>

#include "renderer/base/clocks.h"
#include "renderer/base/error.h"

namespace lull {

namespace {

struct TimeLeft {
    // The end of all work, the predicted end, the end of blocks that all go to the cap, or a time
    // limit, at which adaptive renders end at the latest.
    enum class End { Work, Prediction, Cap, Limit };

    double seconds;
    End end;
    std::optional<std::array<double, 2>> range = {};  // of a prediction, in seconds

    bool IsBound() const { return end == End::Cap || end == End::Limit; }
};

std::optional<TimeLeft> Remaining(const RenderProgress& p, double rate, bool adaptive) {
    using End = TimeLeft::End;
    std::optional<TimeLeft> left;
    if (p.samplesToCap == 0)
        left = {0, adaptive ? End::Cap : End::Work};
    else if (adaptive && p.predictedSeconds)
        left = {*p.predictedSeconds, End::Prediction, p.secondsRange};
    else if (rate > 0 && (!adaptive || p.stoppedBlocks > 0))
        left = {double(p.samplesToCap) / rate, adaptive ? End::Cap : End::Work};
    if (!p.secondsLeft) return left;
    const double clock = std::max(0.0, *p.secondsLeft);
    if (left && left->range)
        for (double& end : *left->range) end = std::min(end, clock);
    if (!left || clock < left->seconds) left = {clock, adaptive ? End::Limit : End::Work};
    return left;
}

std::string TextOf(const TimeLeft& left) {
    const std::string time = FormatDuration(left.seconds);
    if (left.range) return "done in " + FormatRange(*left.range) + " (80 %)";
    return left.end == TimeLeft::End::Prediction ? "about " + time + " left"
           : left.end == TimeLeft::End::Cap      ? time + " to the cap"
           : left.end == TimeLeft::End::Limit    ? "at most " + time + " left"
                                                 : time + " left";
}

int ColumnsOf(std::FILE* stream) {
    constexpr int kUsualColumns = 80;
    winsize size = {};
    return ioctl(fileno(stream), TIOCGWINSZ, &size) == 0 && size.ws_col > 0 ? size.ws_col
                                                                            : kUsualColumns;
}

}  // namespace

void RateMeter::Add(const RenderProgress& p) {
    history.push_back(p);
    // Keep one entry from before the window, so that it is always covered.
    while (history.size() > 2 && history[1].seconds <= p.seconds - kWindow) history.pop_front();
}

double RateMeter::SamplesPerSecond() const {
    if (history.empty()) return 0;
    const RenderProgress& last = history.back();
    // Measure from the start until the window has moved off it.
    const bool fromStart = last.seconds <= kWindow || history.size() < 2;
    const double seconds = last.seconds - (fromStart ? 0 : history.front().seconds);
    const int64_t samples = last.samples - (fromStart ? 0 : history.front().samples);
    return seconds > 0 ? double(samples) / seconds : 0;
}

std::string FormatDuration(double seconds) {
    if (!(seconds >= 0)) seconds = 0;
    if (seconds < 59.95) return fmt::format("{:.1f}s", seconds);
    const int64_t s = int64_t(std::min(seconds, 1e15) + 0.5);
    if (s < 3600) return fmt::format("{}:{:02}", s / 60, s % 60);
    return fmt::format("{}:{:02}:{:02}", s / 3600, s / 60 % 60, s % 60);
}

std::string FormatRange(const std::array<double, 2>& seconds) {
    const auto [unit, name] = seconds[1] < 300     ? std::pair(1, "s")
                              : seconds[1] < 18000 ? std::pair(60, "min")
                                                   : std::pair(3600, "h");
    return fmt::format("{:.0f} to {:.0f} {}", std::floor(seconds[0] / unit),
                       std::ceil(seconds[1] / unit), name);
}

std::string FormatCount(double count) {
    static constexpr const char* kUnits[] = {"", "k", "M", "G", "T"};
    int unit = 0;
    while (count >= 999.5 && unit < 4) {
        count /= 1000;
        ++unit;
    }
    const int decimals = unit == 0 || count >= 99.95 ? 0 : count >= 9.995 ? 1 : 2;
    return fmt::format("{:.{}f}{}{}", count, decimals, unit > 0 ? " " : "", kUnits[unit]);
}

double ShareDone(const RenderProgress& p) {
    const double all = double(p.samples) + p.predictedSamples.value_or(double(p.samplesToCap));
    return all > 0 ? double(p.samples) / all : 1;
}

std::string ProgressText(const ProgressState& state, int columns) {
    const RenderProgress& p = state.progress;
    // Rounded down, so that 100 means done.
    const std::string percent = fmt::format("{:3}%", int(100 * state.share));
    const std::string blocks = fmt::format("{}/{}", p.stoppedBlocks, p.blocks);
    const std::string rate = FormatCount(state.rate), time = FormatDuration(p.seconds);
    std::string left;
    if (const auto l = Remaining(p, state.rate, state.adaptive); p.samplesToCap > 0 && l)
        left = "  " + TextOf(*l);
    const std::string forms[] = {
        fmt::format("{}  {} blocks done  median {} spp  {} samples/s  {} elapsed{}", percent,
                    blocks, p.medianSpp, rate, time, left),
        fmt::format("{}  {} blocks  {} spp  {}/s  {}{}", percent, blocks, p.medianSpp, rate, time,
                    left),
        fmt::format("{}  {} blocks  {}{}", percent, blocks, time, left),
        fmt::format("{}  {}{}", percent, time, left), percent};
    for (const std::string& form : forms)
        if (columns <= 0 || int(form.size()) <= columns) return form;
    return percent.substr(0, size_t(columns));
}

std::string ProgressJson(const ProgressState& state) {
    const RenderProgress& p = state.progress;
    const std::optional<TimeLeft> left = Remaining(p, state.rate, state.adaptive);
    const std::string remaining = p.samplesToCap == 0 ? "0"
                                  : left              ? fmt::format("{:.3f}", left->seconds)
                                                      : "null";
    const std::string range =
        left && left->range ? fmt::format("[{:.3f},{:.3f}]", (*left->range)[0], (*left->range)[1])
                            : "null";
    return fmt::format(
        R"({{"event":"progress","percent":{:.2f},"blocks":{},"cleanBlocks":{},"blocksAtCap":{},)"
        R"("medianSpp":{},"samples":{},"samplesPerSecond":{:.1f},"elapsedSeconds":{:.3f},)"
        R"("remainingSeconds":{},"remainingRange":{},"remainingIsUpperBound":{}}})",
        100 * state.share, p.blocks, p.stoppedBlocks - p.blocksAtCap, p.blocksAtCap, p.medianSpp,
        p.samples, state.rate, p.seconds, remaining, range,
        left ? left->IsBound() : state.adaptive);
}

ProgressStyle StyleOfReports(bool json, bool quiet) {
    return json                    ? ProgressStyle::Json
           : quiet                 ? ProgressStyle::Silent
           : isatty(STDERR_FILENO) ? ProgressStyle::Line
                                   : ProgressStyle::Plain;
}

void PrintReport(const std::string& text, ProgressStyle style, std::FILE* stream) {
    if (style == ProgressStyle::Silent) return;
    // Returns to the start of the line and, at its end, erases the earlier text.
    if (style == ProgressStyle::Line)
        PrintTo(stream, "\r{}\x1b[K", text);
    else
        PrintTo(stream, "{}\n", text);
    std::fflush(stream);
}

void ProgressPrinter::Print(const RenderProgress& p) {
    if (style == ProgressStyle::Silent) return;
    rate.Add(p);
    share = std::max(share, ShareDone(p));
    const ProgressState state{p, share, rate.SamplesPerSecond(), adaptive};
    // The first forecast of a long render does not wait for its turn.
    const bool isNews = !hasForecast && p.secondsRange && (*p.secondsRange)[1] > 30;
    if (style == ProgressStyle::Plain && p.seconds < nextPlainLine && !isNews) return;
    hasForecast |= p.secondsRange.has_value();
    last = p;
    if (style == ProgressStyle::Plain) nextPlainLine = p.seconds + 30;
    // A line that is full would continue in the next.
    const int columns = style == ProgressStyle::Line ? ColumnsOf(stream) - 1 : 0;
    PrintReport(style == ProgressStyle::Json ? ProgressJson(state) : ProgressText(state, columns),
                style, stream);
}

void ProgressPrinter::Finish(const RenderProgress& p) {
    nextPlainLine = 0;
    if (last != p) Print(p);
    if (style == ProgressStyle::Line) PrintTo(stream, "\n");
    std::fflush(stream);
}

namespace {

std::optional<double> SecondsLeft(double share, double seconds) {
    if (!(share > 0)) return {};
    return seconds * (1 - share) / share;
}

double SecondsBetweenReports(ProgressStyle style) {
    return style == ProgressStyle::Plain ? 30 : style == ProgressStyle::Json ? 1 : 0.25;
}

}  // namespace

std::string StepText(const std::string& name, double share, double seconds) {
    std::string text =
        fmt::format("{:3}%  {}  {} elapsed", int(100 * share), name, FormatDuration(seconds));
    if (const auto left = SecondsLeft(share, seconds))
        text += fmt::format("  about {} left", FormatDuration(*left));
    return text;
}

std::string StepJson(const std::string& name, double share, double seconds) {
    const auto left = SecondsLeft(share, seconds);
    return fmt::format(R"({{"event":"step","name":"{}","percent":{:.2f},"elapsedSeconds":{:.3f},)"
                       R"("remainingSeconds":{}}})",
                       name, 100 * share, seconds, left ? fmt::format("{:.3f}", *left) : "null");
}

StepPrinter::StepPrinter(std::string name, ProgressStyle style, std::FILE* stream)
    : name(std::move(name)),
      style(style),
      stream(stream),
      nextReport(std::max(2.0, SecondsBetweenReports(style))) {}

void StepPrinter::Print(double share) {
    const double seconds = SecondsSince(start);
    if (style == ProgressStyle::Silent || seconds < nextReport) return;
    nextReport = seconds + SecondsBetweenReports(style);
    PrintReport(style == ProgressStyle::Json ? StepJson(name, share, seconds)
                                             : StepText(name, share, seconds),
                style, stream);
    hasPrinted = true;
}

StepPrinter::~StepPrinter() {
    if (hasPrinted && style == ProgressStyle::Line) PrintReport("", style, stream);
}

}  // namespace lull
