// Tells how far a training is: a line on a terminal, plain lines in a log, or JSON for programs.
#pragma once

#include <chrono>
#include <cstdio>
#include <string>

#include "renderer/progress/progress.h"
#include "stopping/lab/training/training.h"

namespace lull {

class TrainingPrinter {
  public:
    // `stream` must outlive the printer.
    TrainingPrinter(ProgressStyle style, std::FILE* stream) : style(style), stream(stream) {}

    // Begins a training, said to be about `name` (which may be empty), that stands at `progress`.
    void Begin(const std::string& name, const TrainingProgress& progress);
    // Returns whether the next report is due.
    bool IsDue() const;
    void Print(const TrainingProgress& progress);
    // Prints the last state, and ends the line.
    void Finish(const TrainingProgress& progress);

  private:
    double Seconds() const;

    ProgressStyle style;
    std::FILE* stream;
    std::string name = {};
    std::chrono::steady_clock::time_point start = {};
    int64_t samplesBefore = 0;  // of a training that is resumed
    double nextReport = 0;      // seconds since the start
};

}  // namespace lull
