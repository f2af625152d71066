#include "stopping/lab/evaluation/statistics.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <stdexcept>

namespace lull::probit_test {
namespace {

TEST(Probit, FindsTheCoefficientsThatMadeTheAnswers) {
    std::mt19937 generator(3);
    std::normal_distribution<double> gauss;
    const int count = 20000;
    Eigen::MatrixXd rows(count, 2);
    Eigen::VectorXd answers(count);
    for (int i = 0; i < count; ++i) {
        rows(i, 0) = 1;
        rows(i, 1) = 2 * gauss(generator);
        answers[i] = 0.4 - 1.3 * rows(i, 1) > gauss(generator);
    }
    const ProbitFit fit = FitProbit(rows, answers);
    EXPECT_NEAR(fit.coefficients[0], 0.4, 0.06);
    EXPECT_NEAR(fit.coefficients[1], -1.3, 0.06);

    // No other coefficients have a larger likelihood.
    const auto likelihood = [&](double a, double b) {
        double sum = 0;
        for (int i = 0; i < count; ++i) {
            const double p = 0.5 * std::erfc(-(a + b * rows(i, 1)) / std::sqrt(2.0));
            sum += std::log(answers[i] > 0 ? p : 1 - p);
        }
        return sum;
    };
    const double a = fit.coefficients[0], b = fit.coefficients[1];
    EXPECT_NEAR(likelihood(a, b), fit.logLikelihood, 1e-6 * count);
    for (const double step : {-0.01, 0.01}) {
        EXPECT_LT(likelihood(a + step, b), fit.logLikelihood);
        EXPECT_LT(likelihood(a, b + step), fit.logLikelihood);
    }
}

TEST(Probit, IsTheShareWhereThereIsOnlyAConstant) {
    Eigen::VectorXd answers = Eigen::VectorXd::Zero(40);
    answers.head(10).setOnes();
    const ProbitFit fit = FitProbit(Eigen::MatrixXd::Ones(40, 1), answers);
    EXPECT_NEAR(fit.coefficients[0], -0.6744897501960817, 1e-6);
    EXPECT_NEAR(fit.logLikelihood, 10 * std::log(0.25) + 30 * std::log(0.75), 1e-8);
    // A column that says nothing changes nothing.
    const ProbitFit twice = FitProbit(Eigen::MatrixXd::Ones(40, 2), answers);
    EXPECT_NEAR(twice.logLikelihood, fit.logLikelihood, 1e-6);
}

TEST(Probit, StaysFiniteWhereAnswersAreToldApartWithoutAnError) {
    Eigen::MatrixXd rows(6, 2);
    rows << 1, -3, 1, -2, 1, -1, 1, 1, 1, 2, 1, 300;
    Eigen::VectorXd answers(6);
    answers << 0, 0, 0, 1, 1, 1;
    const ProbitFit fit = FitProbit(rows, answers);
    EXPECT_TRUE(fit.coefficients.allFinite());
    EXPECT_GT(fit.coefficients[1], 0);
    EXPECT_LE(fit.logLikelihood, 0);
    EXPECT_NEAR(fit.logLikelihood, 0, 1e-5);
    // One answer that contradicts all others, far away.
    answers[5] = 0;
    const ProbitFit other = FitProbit(rows, answers);
    EXPECT_TRUE(other.coefficients.allFinite());
    EXPECT_LT(other.logLikelihood, -1);
}

TEST(Probit, RefusesWhatItCannotFit) {
    const Eigen::MatrixXd rows = Eigen::MatrixXd::Ones(3, 1);
    EXPECT_THROW(FitProbit(Eigen::MatrixXd(0, 1), Eigen::VectorXd(0)), std::invalid_argument);
    EXPECT_THROW(FitProbit(rows, Eigen::VectorXd::Zero(2)), std::invalid_argument);
    EXPECT_THROW(
        FitProbit(rows * std::numeric_limits<double>::infinity(), Eigen::VectorXd::Zero(3)),
        std::invalid_argument);
}

}  // namespace
}  // namespace lull::probit_test
