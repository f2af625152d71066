// Fits probabilities of yes and no to numbers, by maximum likelihood.
#pragma once

#include <Eigen/Core>

namespace lull {

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

}  // namespace lull
