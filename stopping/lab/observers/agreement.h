// Computes the agreement of several observers.
#pragma once

#include <optional>
#include <span>
#include <vector>

namespace lull {

// Returns t such that a variable of Student's distribution with `degrees` (> 0) degrees of freedom
// is between -t and t with a probability of `share`, in (0, 1) (Abramowitz and Stegun 26.7).
double StudentInterval(double share, int degrees);

// Returns the intraclass correlation ICC(2,1) of Shrout and Fleiss (Psychological Bulletin 86(2),
// 1979): the share of the variance of a single rating that the rated things make, rather than
// observers and chance. 1: all say the same. `ratings` has one list for each thing, an entry for
// each observer in it. Nothing if there are not two of both, or no variance.
std::optional<double> IntraclassCorrelation(std::span<const std::vector<double>> ratings);

// Returns in a word how good such an agreement is, by the bounds of Koo and Li (Journal of
// Chiropractic Medicine 15(2), 2016): poor below 0.5, moderate below 0.75, good below 0.9, else
// excellent.
const char* AgreementInAWord(double correlation);

// Returns the standard deviation of a sample, nothing for fewer than two values.
std::optional<double> SampleDeviation(std::span<const double> values);

}  // namespace lull
