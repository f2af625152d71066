// Measures error against effort: for fixed samples per pixel, and for stopping rules over a range
// of their settings.
#pragma once

#include "renderer/lab/comparison/comparison.h"

namespace lull {

// One point of a curve.
struct CurvePoint {
    std::string rule, setting;  // "dammertz", "0.02"; "fixed", "64"
    double spp = 0;             // mean samples per pixel
    double seconds = 0;         // wall-clock time, if all threads were always busy
    double ruleSeconds = 0;     // CPU time
    ErrorFigures figures;
};

// Returns the numbers of samples per pixel at which fixed rendering is measured: from the first
// pass to the cap, each about 1.5 times the last, all ends of passes.
std::vector<int> FixedLadder(int passLength, int cap);

// Returns the rules that are measured, as texts: "fixed:N" for the ladder, and each rule with one
// setting over a range of it.
std::vector<std::string> CurveRules(int passLength, int cap);

// Returns a point for each rule: for the first of them, whose images the comparison begins with, by
// the figures that Measure() gave these, for the others by their images, which are not kept.
std::vector<CurvePoint> MeasureCurves(const MonitoredRender&,
                                      const std::vector<MonitoredRule>& rules, size_t imageCount,
                                      const Comparison&);

}  // namespace lull
