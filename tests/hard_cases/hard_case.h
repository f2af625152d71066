// Inputs built to break a path tracer or a stopping rule, each with a known answer. The tables and
// the test program run the same cases; neither is known here.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

namespace lull {

struct HardCaseOptions {
    bool isLong = false;  // the counts of rays, samples and trials of a nightly run
    uint64_t seed = 1;    // of everything random, so that a failure can be repeated
};

// Result. A case passes if |ours - answer| <= tolerance, which NaN never is.
struct HardCaseResult {
    double answer = 0, ours = 0, tolerance = 0;
    std::string note = "";  // the unit of the figures, and of several trials the one shown

    bool Passed() const;
};

struct HardCase {
    std::string theme;
    std::string name;
    std::string what;  // the error made elsewhere
    std::function<HardCaseResult(const HardCaseOptions&)> run;
};

// Lists all cases, theme by theme.
std::vector<HardCase> AllHardCases();

std::vector<HardCase> MaterialCases();
std::vector<HardCase> GeometryCases();
std::vector<HardCase> LightCases();
std::vector<HardCase> SignalCases();
std::vector<HardCase> HeavyTailCases();
std::vector<HardCase> SparsePointCases();
std::vector<HardCase> DenoisingCases();

// Returns the result that is furthest out of its tolerance, or closest to it. At least one.
HardCaseResult Worst(std::span<const HardCaseResult> results);

// Counts violations of a condition. A note on the first occurrence follows the total.
struct Failures {
    int64_t trials = 0, count = 0;
    std::string first;  // of the first failure: the seed or whatever else repeats it

    void Note(bool failed, const std::function<std::string()>& how);
    HardCaseResult Result(const std::string& trialName) const;
};

// Formats numbers for tables: seven digits, or "1e-09".
std::string NumberText(double value);

}  // namespace lull
