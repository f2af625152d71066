// Measures error against effort: for fixed samples per pixel, and for stopping rules over a range
// of their settings.
#pragma once

#include "renderer/lab/comparison/comparison.h"

namespace lull {

// One point of a curve.
struct BenchPoint {
    std::string rule, setting;  // "dammertz", "0.02"; "fixed", "64"; the name of another renderer
    std::string sampler;        // empty for other renderers
    double spp = 0;             // mean samples per pixel; 0: not known
    double seconds = 0;         // wall-clock; lull's, if all its threads were always busy
    double threadSeconds = 0;   // of processors, the rule's included; 0: not known
    double ruleSeconds = 0;
    bool sharesReference = false;  // shares samples with the reference: its error is understated
    ErrorFigures figures;
};

// Returns the numbers of samples per pixel at which fixed rendering is measured: from the first
// pass to the cap, each about 1.5 times the last, all ends of passes.
std::vector<int> FixedLadder(int passLength, int cap);

// Returns the rules that are measured, as texts: "fixed:N" for the ladder, and each rule with one
// setting over a range of it.
std::vector<std::string> BenchRules(int passLength, int cap);

// Returns a point for each rule, each compared with the reference as a display shows both. Seconds
// are those of `threads` threads that are always busy. `onPoint` is called after each, by one
// thread at a time; it may be empty.
std::vector<BenchPoint> MeasurePoints(const MonitoredRender&,
                                      const std::vector<MonitoredRule>& rules,
                                      const RgbImage& reference, const DisplayModel&, int threads,
                                      const std::function<void()>& onPoint);

// Returns the points as a CSV with a line of column names. Figures that are infinite or not known
// are empty.
std::string BenchCsv(const std::vector<BenchPoint>&);

// Names an image of another renderer.
struct ExternalImage {
    std::string name;
    double seconds = 0;
    std::string file;
};

// Reads lines "name,seconds,file.exr"; files are looked for beside the CSV. Empty lines and a line
// of column names are skipped. Throws Error with file and line.
std::vector<ExternalImage> ReadExternalImages(const std::string& csv);

// Returns the point of an image that has been read; it must have the reference's size.
BenchPoint MeasureExternal(const ExternalImage&, const RgbImage& image, const RgbImage& reference,
                           const DisplayModel&);

}  // namespace lull
