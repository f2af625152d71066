// Computes rank correlations.
#pragma once

#include <optional>
#include <span>

namespace lull {

// Returns Spearman's rank correlation of pairs of numbers, in [-1, 1]; equal numbers share the mean
// of their ranks. Nothing where there are fewer than three pairs, or all numbers of one side are
// the same. Throws std::invalid_argument if the lengths differ or a number is NaN.
std::optional<double> RankCorrelation(std::span<const double> a, std::span<const double> b);

}  // namespace lull
