#include "stopping/lab/evaluation/probit.h"

#include <Eigen/Cholesky>
#include <cmath>
#include <numbers>
#include <stdexcept>

namespace lull {

namespace {

constexpr double kFarBelow = -30;  // where the tail is its asymptote to double precision
constexpr int kMostSteps = 200;
constexpr double kLeastGain = 1e-9;  // of the log likelihood in a step
// Keeps the matrix of a step regular where columns say nothing.
constexpr double kRidge = 1e-8;

// The normal distribution: the logarithm of its distribution function, and its density over that.
double LogOfDistribution(double x) {
    if (x > kFarBelow) return std::log(0.5 * std::erfc(-x / std::numbers::sqrt2));
    return -0.5 * x * x - std::log(-x) - 0.5 * std::log(2 * std::numbers::pi) -
           std::log1p(1 / (x * x));
}
double Hazard(double x) {
    if (x <= kFarBelow) return -x - 1 / x;
    return std::exp(-0.5 * x * x - LogOfDistribution(x)) / std::sqrt(2 * std::numbers::pi);
}

double LogLikelihood(const Eigen::VectorXd& scores, const Eigen::VectorXd& weights) {
    double sum = 0;
    for (Eigen::Index i = 0; i < scores.size(); ++i)
        sum += weights[i] * LogOfDistribution(scores[i]);
    return sum;
}

}  // namespace

ProbitFit FitProbit(const Eigen::MatrixXd& rows, const Eigen::VectorXd& answers,
                    const Eigen::VectorXd& given) {
    if (rows.rows() == 0 || rows.rows() != answers.size())
        throw std::invalid_argument("a probit needs answers, and as many rows");
    const Eigen::VectorXd counts = given.size() > 0 ? given : Eigen::VectorXd::Ones(answers.size());
    if (counts.size() != answers.size() || !(counts.array() > 0).all())
        throw std::invalid_argument("a probit needs a weight above 0 for each answer");
    if (!rows.allFinite() || !answers.allFinite() || !counts.allFinite())
        throw std::invalid_argument("a probit needs finite numbers");

    // A no is a yes to the opposite.
    const Eigen::VectorXd signs = (2 * answers.array() - 1).matrix();
    const Eigen::MatrixXd signedRows = signs.asDiagonal() * rows;
    ProbitFit fit{.coefficients = Eigen::VectorXd::Zero(rows.cols())};
    fit.logLikelihood = LogLikelihood(signedRows * fit.coefficients, counts);
    for (int step = 0; step < kMostSteps; ++step) {
        const Eigen::VectorXd scores = signedRows * fit.coefficients;
        const Eigen::VectorXd hazards = scores.unaryExpr(&Hazard);
        const Eigen::VectorXd weights =
            counts.array() * (hazards.array() * (hazards + scores).array()).max(0);
        Eigen::MatrixXd information = signedRows.transpose() * weights.asDiagonal() * signedRows;
        information.diagonal().array() += kRidge;
        // Newton's step, halved until it is one upwards; the likelihood is concave.
        Eigen::VectorXd move =
            information.ldlt().solve(signedRows.transpose() * counts.cwiseProduct(hazards));
        double better = LogLikelihood(signedRows * (fit.coefficients + move), counts);
        for (int i = 0; i < 40 && !(better >= fit.logLikelihood); ++i) {
            move /= 2;
            better = LogLikelihood(signedRows * (fit.coefficients + move), counts);
        }
        const double gain = better - fit.logLikelihood;
        if (!(gain > 0)) break;
        fit.coefficients += move;
        fit.logLikelihood = better;
        if (gain < kLeastGain) break;
    }
    return fit;
}

}  // namespace lull
