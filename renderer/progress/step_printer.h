// Reports how much of a step that follows the render is done, such as the denoising of a large
// picture.
#pragma once

#include <chrono>

#include "renderer/progress/progress.h"

namespace lull {

class StepPrinter {
  public:
    // Begins a step. `stream` must outlive the printer.
    StepPrinter(std::string name, ProgressStyle style, std::FILE* stream);
    StepPrinter(const StepPrinter&) = delete;
    // Erases a line of a terminal: the result takes its place.
    ~StepPrinter();

    // Prints the share of the step that is done, in [0, 1], unless the last report is not long ago
    // or the step has only begun: most of them take no time.
    void Print(double share);

  private:
    std::string name;
    ProgressStyle style;
    std::FILE* stream;
    std::chrono::steady_clock::time_point start = std::chrono::steady_clock::now();
    double nextReport;  // seconds since the start
    bool hasPrinted = false;
};

// Formats a report. The rest is expected to take as long, share by share, as before.
std::string StepText(const std::string& name, double share, double seconds);
std::string StepJson(const std::string& name, double share, double seconds);

}  // namespace lull
