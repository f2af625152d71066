#include "renderer/progress/step_printer.h"

#include <fmt/format.h>

#include <algorithm>

#include "renderer/base/clocks.h"

namespace lull {

namespace {

std::optional<double> SecondsLeft(double share, double seconds) {
    if (!(share > 0)) return {};
    return seconds * (1 - share) / share;
}

double SecondsBetweenReports(ProgressStyle style) {
    switch (style) {
        case ProgressStyle::Plain:
            return 30;
        case ProgressStyle::Json:
            return 1;
        default:
            return 0.25;
    }
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
