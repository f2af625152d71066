#include "renderer/render/progress.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "renderer/base/say.h"

namespace lull {

namespace {

double Fraction(const RenderProgress& p) {
    const double all = double(p.samples) + p.predictedSamples.value_or(double(p.samplesToCap));
    return all > 0 ? double(p.samples) / all : 1;
}

struct TimeLeft {
    double seconds;
    bool isBound;  // or less
};

// Says how long it takes from here; nothing where nobody knows.
std::optional<TimeLeft> Remaining(const RenderProgress& p, double rate, bool adaptive) {
    std::optional<TimeLeft> left;
    if (p.samplesToCap == 0)
        left = {0, adaptive};
    else if (adaptive && p.predictedSeconds)
        left = {*p.predictedSeconds, false};
    else if (rate > 0)
        left = {double(p.samplesToCap) / rate, adaptive};
    if (!p.secondsLeft) return left;
    const double clock = std::max(0.0, *p.secondsLeft);
    if (!left || clock < left->seconds) left = {clock, adaptive};
    return left;
}

// Rounds down, so that 100 means done.
int Percent(const RenderProgress& p) { return int(100 * Fraction(p)); }

}  // namespace

void RateMeter::Add(const RenderProgress& p) {
    history.push_back(p);
    // Keep one entry from before the window, so that it is always covered.
    while (history.size() > 2 && history[1].seconds <= p.seconds - window) history.pop_front();
}

double RateMeter::SamplesPerSecond() const {
    if (history.empty()) return 0;
    const RenderProgress& last = history.back();
    // Measure from the start until the window has moved off it.
    const bool fromStart = last.seconds <= window || history.size() < 2;
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

std::string FormatCount(double count) {
    static constexpr const char* units[] = {"", "k", "M", "G", "T"};
    int unit = 0;
    while (count >= 999.5 && unit < 4) {
        count /= 1000;
        ++unit;
    }
    const int decimals = unit == 0 || count >= 99.95 ? 0 : count >= 9.995 ? 1 : 2;
    return fmt::format("{:.{}f}{}{}", count, decimals, unit > 0 ? " " : "", units[unit]);
}

std::string ProgressText(const RenderProgress& p, double rate, bool adaptive) {
    std::string text = fmt::format(
        "{:3}%  {}/{} blocks stopped  median {} spp  {} samples/s  {} elapsed", Percent(p),
        p.stoppedBlocks, p.blocks, p.medianSpp, FormatCount(rate), FormatDuration(p.seconds));
    const std::optional<TimeLeft> left = Remaining(p, rate, adaptive);
    if (p.samplesToCap > 0 && left)
        text += fmt::format("  {}{} left",
                            left->isBound ? "at most "
                            : adaptive    ? "about "
                                          : "",
                            FormatDuration(left->seconds));
    return text;
}

std::string ProgressJson(const RenderProgress& p, double rate, bool adaptive) {
    const std::optional<TimeLeft> left = Remaining(p, rate, adaptive);
    const std::string remaining = p.samplesToCap == 0 ? "0"
                                  : left              ? fmt::format("{:.3f}", left->seconds)
                                                      : "null";
    return fmt::format(
        R"({{"percent":{:.2f},"blocks":{},"stoppedBlocks":{},"medianSpp":{},"samples":{},)"
        R"("samplesPerSecond":{:.1f},"elapsedSeconds":{:.3f},"remainingSeconds":{},)"
        R"("remainingIsUpperBound":{}}})",
        100 * Fraction(p), p.blocks, p.stoppedBlocks, p.medianSpp, p.samples, rate, p.seconds,
        remaining, left ? left->isBound : adaptive);
}

void ProgressPrinter::Print(const RenderProgress& p) {
    if (style == ProgressStyle::Silent) return;
    rate.Add(p);
    const double r = rate.SamplesPerSecond();
    if (style == ProgressStyle::Json) {
        SayTo(stream, "{}\n", ProgressJson(p, r, adaptive));
    } else if (style == ProgressStyle::Line) {
        // Return to the start of the line and, at its end, erase what was there before.
        SayTo(stream, "\r{}\x1b[K", ProgressText(p, r, adaptive));
    } else if (p.seconds >= nextPlainLine) {
        SayTo(stream, "{}\n", ProgressText(p, r, adaptive));
        nextPlainLine = p.seconds + 30;
    }
    std::fflush(stream);
}

void ProgressPrinter::Finish(const RenderProgress& p) {
    nextPlainLine = 0;
    Print(p);
    if (style == ProgressStyle::Line) SayTo(stream, "\n");
    std::fflush(stream);
}

}  // namespace lull
