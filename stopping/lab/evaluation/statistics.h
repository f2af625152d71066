// Statistics of evaluations.
#pragma once

#include <Eigen/Core>

#include <optional>
#include <span>
#include <vector>

namespace lull {

struct Interval {
    double low = 0, high = 0;
};

// Returns the range of the central 95 % of the mean over viewpoints of the means over their blocks,
// where both are drawn again with replacement (Efron's bootstrap, percentiles of 2,000 draws with a
// fixed seed); where there is one viewpoint, blocks alone. `values` has the blocks of each
// viewpoint; every viewpoint has a block. With few viewpoints it is too narrow. Throws
// std::invalid_argument if there is no viewpoint or one has no block.
Interval BootstrapInterval(std::span<const std::vector<double>> values);

struct ProbitFit {
    Eigen::VectorXd coefficients;
    double logLikelihood = 0;  // natural, <= 0
};

// Fits the probability of a yes, the distribution function of the normal distribution at
// `rows` * coefficients, to answers of 0 and 1, one a row. Where answers can be told apart without
// an error coefficients are large, and the likelihood is within 1e-6 of its supremum. Coefficients
// of columns that say nothing are of no meaning. Throws std::invalid_argument if there are no rows,
// sizes do not fit or a number is not finite. Each answer counts as so many as its weight, > 0,
// says; without weights as one.
ProbitFit FitProbit(const Eigen::MatrixXd& rows, const Eigen::VectorXd& answers,
                    const Eigen::VectorXd& weights = {});

// Returns Spearman's rank correlation of pairs of numbers, in [-1, 1]; equal numbers share the mean
// of their ranks. Nothing where there are fewer than three pairs, or all numbers of one side are
// the same. Throws std::invalid_argument if the lengths differ or a number is NaN.
std::optional<double> RankCorrelation(std::span<const double> a, std::span<const double> b);

// Measures how well numbers tell two classes apart.

// Returns the area under the curve of the receiver operating characteristic: the probability that
// a sample with the label 1 has a higher score than one with 0; equal scores count one half. 0.5
// if there are no two classes. Throws std::invalid_argument if the lengths differ or a score is
// NaN.
double AreaUnderRoc(std::span<const float> scores, std::span<const char> labels);

}  // namespace lull
