#include "renderer/lab/commands/training_printer.h"

#include <fmt/format.h>

#include "renderer/base/clocks.h"
#include "renderer/base/error.h"

namespace lull {

void TrainingPrinter::Begin(const std::string& about, const TrainingProgress& progress) {
    name = about;
    start = std::chrono::steady_clock::now();
    samplesBefore = progress.samples;
    nextReport = 0;
}

double TrainingPrinter::Seconds() const { return SecondsSince(start); }

bool TrainingPrinter::IsDue() const {
    return style != ProgressStyle::Silent && Seconds() >= nextReport;
}

void TrainingPrinter::Print(const TrainingProgress& p) {
    if (style == ProgressStyle::Silent) return;
    const double seconds = Seconds();
    const double rate = seconds > 0 ? double(p.samples - samplesBefore) / seconds : 0;
    const double left = rate > 0 ? double(p.allSamples - p.samples) / rate : 0;
    nextReport = seconds + (style == ProgressStyle::Plain ? 30 : 0.25);
    const std::string text =
        style == ProgressStyle::Json
            ? fmt::format(
                  R"({{"training":"{}","epoch":{},"epochs":{},"samples":{},"allSamples":{},)"
                  R"("loss":{:.6f},"auc":{:.6f},"samplesPerSecond":{:.1f},)"
                  R"("remainingSeconds":{:.1f}}})",
                  name, p.epoch, p.epochs, p.samples, p.allSamples, p.loss, p.auc, rate, left)
            : fmt::format("{}{}epoch {}/{}  loss {:.4f}  AUC {:.3f}  {} samples/s  {} left", name,
                          name.empty() ? "" : "  ", p.epoch, p.epochs, p.loss, p.auc,
                          FormatCount(rate), FormatDuration(left));
    PrintReport(text, style, stream);
}

void TrainingPrinter::Finish(const TrainingProgress& progress) {
    Print(progress);
    if (style == ProgressStyle::Line) PrintTo(stream, "\n");
    std::fflush(stream);
}

}  // namespace lull
