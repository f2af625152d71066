// Progress of a render: a line on a terminal, plain lines in a log, or JSON for programs.
#pragma once

#include <array>
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <deque>
#include <optional>
#include <string>

namespace lull {

struct RenderProgress {
    int blocks = 0, stoppedBlocks = 0;
    int blocksAtCap = 0;                     // of those, how many no rule has stopped before
    int medianSpp = 0;                       // over the blocks
    int64_t samples = 0;                     // taken so far
    int64_t samplesToCap = 0;                // still to take if no block stops before the cap
    double seconds = 0;                      // since the start
    std::optional<double> secondsLeft = {};  // of a clock that ends the render
    // Still to take until the rule has stopped all blocks, and how long that takes, if it can be
    // predicted; and the range that holds the seconds in 80 of 100 renders (RangeOfRest()).
    std::optional<double> predictedSamples = {}, predictedSeconds = {};
    std::optional<std::array<double, 2>> secondsRange = {};

    bool operator==(const RenderProgress&) const = default;
};

// Estimates the speed from recent work, since the blocks that are left can be slower.
class RateMeter {
  public:
    void Add(const RenderProgress&);
    double SamplesPerSecond() const;  // 0: not known

  private:
    static constexpr double kWindow = 30;  // seconds
    std::deque<RenderProgress> history;
};

// Returns the share of all samples, in [0, 1], that have been taken, so far as it can be predicted.
double ShareDone(const RenderProgress&);

// Contents of a progress report. If blocks stop by themselves (`adaptive`) the time left is a
// prediction; while there is none, an upper bound, or before the first block has stopped nothing.
struct ProgressState {
    RenderProgress progress;
    double share = 0;  // done, in [0, 1]
    double rate = 0;   // samples per second; 0: not known
    bool adaptive = false;
};

// Formats a report of progress. With `columns` > 0 it fits into so many; the least important parts
// are then shortened or left out.
std::string ProgressText(const ProgressState&, int columns = 0);
std::string ProgressJson(const ProgressState&);

// Formats a range of seconds as "9 to 14 min": seconds, minutes or hours, rounded outwards.
std::string FormatRange(const std::array<double, 2>& seconds);
// Formats seconds as "12.3s", "4:05" or "1:02:03".
std::string FormatDuration(double seconds);
// Formats a count with three digits and k, M, G or T.
std::string FormatCount(double count);

enum class ProgressStyle {
    Silent,
    Line,   // one line, rewritten in place; for terminals
    Plain,  // a line about every 30 seconds
    Json    // one object per line
};

ProgressStyle StyleOfReports(bool json, bool quiet);

// Prints a report by its style: over the last one, or as a line of its own. `text` fits on a line.
void PrintReport(const std::string& text, ProgressStyle, std::FILE* stream);

class ProgressPrinter {
  public:
    // `stream` must outlive the printer.
    ProgressPrinter(ProgressStyle style, bool adaptive, std::FILE* stream)
        : style(style), adaptive(adaptive), stream(stream) {}

    // The completed fraction never decreases, although predictions may.
    void Print(const RenderProgress&);
    // Prints the last state, unless that was printed, and ends the line.
    void Finish(const RenderProgress&);

  private:
    ProgressStyle style;
    bool adaptive;
    std::FILE* stream;
    RateMeter rate;
    double share = 0;                    // the most that was printed
    std::optional<RenderProgress> last;  // that was printed
    bool hasForecast = false;            // was printed in a plain line
    double nextPlainLine = 30;           // seconds since the start
};

// Reports how much of a step after the render is done, such as the denoising of a picture.

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
