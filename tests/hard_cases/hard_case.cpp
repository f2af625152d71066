#include "tests/hard_cases/hard_case.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>

namespace lull {

bool HardCaseResult::Passed() const { return std::abs(ours - answer) <= tolerance; }

std::vector<HardCase> AllHardCases() {
    std::vector<HardCase> all;
    for (const auto& theme : {MaterialCases, GeometryCases, LightCases, SignalCases, HeavyTailCases,
                              SparsePointCases, DenoisingCases}) {
        std::vector<HardCase> cases = theme();
        std::move(cases.begin(), cases.end(), std::back_inserter(all));
    }
    return all;
}

HardCaseResult Worst(std::span<const HardCaseResult> results) {
    // A tolerance of zero admits no error at all; NaN is worse than any other.
    const auto severity = [](const HardCaseResult& r) {
        const double error = std::abs(r.ours - r.answer);
        if (std::isnan(error)) return HUGE_VAL;
        return error == 0 ? 0 : error / r.tolerance;
    };
    return *std::max_element(results.begin(), results.end(), [&](const auto& a, const auto& b) {
        return severity(a) < severity(b);
    });
}

void Failures::Note(bool failed, const std::function<std::string()>& how) {
    ++trials;
    if (failed && count++ == 0) first = how();
}

HardCaseResult Failures::Result(const std::string& trialName) const {
    std::string note = fmt::format("of {:.2g} {}", double(trials), trialName);
    if (count > 0) note += ", first: " + first;
    return {.answer = 0, .ours = double(count), .tolerance = 0, .note = note};
}

std::string NumberText(double value) { return fmt::format("{:.7g}", value); }

}  // namespace lull
