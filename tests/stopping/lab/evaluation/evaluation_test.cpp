#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <stdexcept>
#include <vector>

#include "stopping/lab/evaluation/evaluation.h"
#include "stopping/rules/thresholds.h"
#include "tests/stopping/golden_data.h"

namespace lull {
namespace {

double ErrorOf(int human, int stop, double margin, int grid) {
    const BlockOutcome block{.human = human, .outcome = {.stop = stop}};
    return CriticalError({&block, 1}, margin, grid);
}

TEST(CriticalError, CountsTheSppThatAreWrong) {
    // 2 % of 10,000 spp are 100 below and above. Of the 500 spp of grid 20, 820 to 900 are wrong
    // where the stop is at 800, and 1100 to 1180 where it is at 1200.
    EXPECT_EQ(ErrorOf(1000, 1000, 2, 20), 0);
    EXPECT_EQ(ErrorOf(1000, 900, 2, 20), 0);
    EXPECT_EQ(ErrorOf(1000, 1100, 2, 20), 0);
    EXPECT_DOUBLE_EQ(ErrorOf(1000, 800, 2, 20), 5 / 500.0);
    EXPECT_DOUBLE_EQ(ErrorOf(1000, 1200, 2, 20), 5 / 500.0);
    EXPECT_EQ(ErrorOf(1000, 800, 6, 20), 0);
    // Grid 40 has 20, 60, ..., 9980: 820, 860 and 900; 1100, 1140 and 1180.
    EXPECT_DOUBLE_EQ(ErrorOf(1000, 800, 2, 40), 3 / 250.0);
    EXPECT_DOUBLE_EQ(ErrorOf(1000, 1200, 2, 40), 3 / 250.0);
    // Without a margin, only the threshold itself is right on both sides.
    EXPECT_DOUBLE_EQ(ErrorOf(1000, 940, 0, 20), 2 / 500.0);
    // A margin of 1 % is 50 spp, two passes.
    EXPECT_DOUBLE_EQ(ErrorOf(1000, 900, 1, 20), 3 / 500.0);
}

TEST(CriticalError, HasNoMarginWherePeopleSawNoiseAtTheCap) {
    EXPECT_EQ(ErrorOf(10000, 10000, 10, 20), 0);
    EXPECT_DOUBLE_EQ(ErrorOf(10000, 9000, 2, 20), 49 / 500.0);  // 9020 to 9980
    EXPECT_DOUBLE_EQ(ErrorOf(10000, 9000, 10, 20), 49 / 500.0);
    EXPECT_DOUBLE_EQ(ErrorOf(10000, 0, 2, 40), 1);
    EXPECT_DOUBLE_EQ(ErrorOf(20, 10000, 0, 40), 249 / 250.0);
}

TEST(CriticalError, IsTheMeanOverBlocks) {
    const std::vector<BlockOutcome> blocks = {{1000, {.stop = 1000}}, {1000, {.stop = 800}}};
    EXPECT_DOUBLE_EQ(CriticalError(blocks, 2, 20), 2.5 / 500);
    EXPECT_EQ(CriticalError({}, 2, 20), 0);
}

TEST(CriticalError, IsThePublishedOne) {
    const std::vector<ThresholdsRow> human = ReadThresholds(ThresholdsFile("human.csv"));
    const struct {
        const char* file;
        int grid;
        double percent[3];
    } published[] = {{"svd-entropy-rnn.csv", 40, {14.79, 13.25, 11.89}},
                     {"26-attributes-rnn.csv", 20, {17.82, 16.205, 14.73}}};
    for (const auto& [file, grid, percent] : published) {
        std::vector<ViewpointOutcome> viewpoints;
        for (const ThresholdsRow& row : ReadThresholds(ThresholdsFile(file))) {
            const auto people = std::ranges::find(human, row.name, &ThresholdsRow::name);
            if (people == human.end()) continue;
            viewpoints.push_back({.name = row.name});
            for (size_t i = 0; i < row.spp.size(); ++i)
                viewpoints.back().blocks.push_back({people->spp[i], {.stop = row.spp[i]}});
        }
        const Scores scores = Score(viewpoints, {.grid = grid});
        EXPECT_EQ(scores.viewpoints, 40);
        EXPECT_EQ(scores.blocks, 640);
        for (size_t i = 0; i < 3; ++i)
            EXPECT_NEAR(100 * scores.criticalErrors[i], percent[i], 0.005) << file;
    }
}

TEST(Scores, AveragesOverViewpoints) {
    // The first has blocks 500 early and 100 late, the second one that is right.
    const std::vector<ViewpointOutcome> viewpoints = {
        {.name = "a", .blocks = {{2000, {.stop = 1500}}, {300, {.stop = 400, .open = true}}}},
        {.name = "b", .blocks = {{1000, {.stop = 800}}}},
        {.name = "nothing"}};
    const Scores scores = Score(viewpoints, {.grid = 20, .margins = {0}});
    EXPECT_EQ(scores.viewpoints, 2);
    EXPECT_EQ(scores.blocks, 3);
    EXPECT_EQ(scores.open, 1);
    EXPECT_DOUBLE_EQ(scores.absoluteError, (300 + 200) / 2.0);
    EXPECT_DOUBLE_EQ(scores.early, 0.25);  // 800 is not below 80 % of 1000
    EXPECT_DOUBLE_EQ(scores.late, 0.25);
    ASSERT_EQ(scores.criticalErrors.size(), 1u);
    // Wrong are 1520 to 1980, 320 to 380, and 820 to 980.
    EXPECT_DOUBLE_EQ(scores.criticalErrors[0], ((24 + 4) / 1000.0 + 9 / 500.0) / 2);
    EXPECT_FALSE(scores.auc || scores.accuracy);

    const Scores none = Score({}, {});
    EXPECT_EQ(none.viewpoints, 0);
    EXPECT_EQ(none.absoluteError, 0);
    EXPECT_EQ(none.criticalErrors, (std::vector<double>{0, 0, 0}));
}

TEST(Scores, BalancesTheClasses) {
    // People see noise below 100 spp. Of the two spp below, one is called noisy; of the three from
    // there on, one. Three and a half of the six pairs of scores are in the right order.
    const std::vector<BlockVerdict> verdicts = {
        {20, 0.9, true}, {60, 0.4, false}, {100, 0.4, false}, {140, 0.7, true}, {180, 0.6, false}};
    const ViewpointOutcome viewpoint{
        .name = "a", .blocks = {{.human = 100, .outcome = {.stop = 60, .verdicts = verdicts}}}};
    const Scores scores = Score({&viewpoint, 1}, {});
    ASSERT_TRUE(scores.accuracy && scores.auc);
    EXPECT_DOUBLE_EQ(*scores.accuracy, (1 / 2.0 + 2 / 3.0) / 2);
    EXPECT_DOUBLE_EQ(*scores.auc, 3.5 / 6);
}

TEST(Scores, TakesAStopForADecision) {
    const RuleOutcome outcome = OutcomeOfStop(60, 40);
    EXPECT_EQ(outcome.stop, 60);
    EXPECT_FALSE(outcome.open);
    ASSERT_EQ(outcome.verdicts.size(), 250u);
    EXPECT_EQ(outcome.verdicts[0].spp, 20);
    EXPECT_TRUE(outcome.verdicts[0].noisy);
    EXPECT_EQ(outcome.verdicts[0].score, 3);
    EXPECT_FALSE(outcome.verdicts[1].noisy);
    EXPECT_EQ(outcome.verdicts.back().spp, 9980);

    const ViewpointOutcome right{.name = "a", .blocks = {{60, outcome}}};
    EXPECT_EQ(Score({&right, 1}, {}).accuracy, 1);
    EXPECT_EQ(Score({&right, 1}, {}).auc, 1);
}

TEST(Bootstrap, IsAPointWhereAllIsTheSame) {
    const std::vector<std::vector<double>> values = {{0.25, 0.25}, {0.25}};
    const Interval interval = BootstrapInterval(values);
    EXPECT_EQ(interval.low, 0.25);
    EXPECT_EQ(interval.high, 0.25);
}

// The mean of 100 blocks of one viewpoint scatters by a tenth of the scatter of blocks.
TEST(Bootstrap, HasTheWidthOfTheMean) {
    std::mt19937 generator(7);
    std::normal_distribution<double> gauss(5, 2);
    std::vector<std::vector<double>> values(1);
    for (int i = 0; i < 100; ++i) values[0].push_back(gauss(generator));
    const Interval interval = BootstrapInterval(values);
    EXPECT_NEAR(interval.high - interval.low, 2 * 1.96 * 2 / 10, 0.15);
    EXPECT_LT(interval.low, 5.3);
    EXPECT_GT(interval.high, 4.7);
}

// Differences between viewpoints alone are not known better by more blocks.
TEST(Bootstrap, DrawsViewpoints) {
    const std::vector<std::vector<double>> values = {std::vector<double>(50, 0.0),
                                                     std::vector<double>(50, 1.0)};
    const Interval interval = BootstrapInterval(values);
    EXPECT_EQ(interval.low, 0);
    EXPECT_EQ(interval.high, 1);
}

TEST(Bootstrap, RefusesNothing) {
    EXPECT_THROW(BootstrapInterval({}), std::invalid_argument);
    const std::vector<std::vector<double>> empty = {{1.0}, {}};
    EXPECT_THROW(BootstrapInterval(empty), std::invalid_argument);
}

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

TEST(RankCorrelation, KnowsOrderAlone) {
    const std::vector<double> a = {1, 2, 3, 4, 1000}, b = {-5, 0, 1e-9, 2, 3};
    EXPECT_DOUBLE_EQ(RankCorrelation(a, b).value(), 1);
    const std::vector<double> falling = {5, 4, 3, 2, 1};
    EXPECT_DOUBLE_EQ(RankCorrelation(a, falling).value(), -1);
}

// Spearman's example by hand: ranks 1 2.5 2.5 4 and 1 3 2 4.
TEST(RankCorrelation, SharesRanksOfEqualNumbers) {
    const std::vector<double> a = {1, 7, 7, 9}, b = {1, 3, 2, 4};
    EXPECT_NEAR(RankCorrelation(a, b).value(), 4.5 / std::sqrt(4.5 * 5), 1e-15);
}

TEST(RankCorrelation, IsNothingWithoutOrder) {
    const std::vector<double> two = {1, 2}, same = {3, 3, 3}, three = {1, 2, 3};
    EXPECT_FALSE(RankCorrelation(two, two));
    EXPECT_FALSE(RankCorrelation(same, three));
    EXPECT_THROW(RankCorrelation(two, three), std::invalid_argument);
    const std::vector<double> nan = {1, std::numeric_limits<double>::quiet_NaN(), 2};
    EXPECT_THROW(RankCorrelation(nan, three), std::invalid_argument);
}

double Area(const std::vector<float>& scores, const std::vector<char>& labels) {
    return AreaUnderRoc(scores, labels);
}

TEST(AreaUnderRoc, CountsPairsInTheRightOrder) {
    EXPECT_EQ(Area({0.1f, 0.2f, 0.8f, 0.9f}, {0, 0, 1, 1}), 1);
    EXPECT_EQ(Area({0.1f, 0.2f, 0.8f, 0.9f}, {1, 1, 0, 0}), 0);
    EXPECT_EQ(Area({0.1f, 0.4f, 0.35f, 0.8f}, {0, 0, 1, 1}), 0.75);
    EXPECT_EQ(Area({5, 5, 5, 5}, {0, 1, 0, 1}), 0.5);
    EXPECT_EQ(Area({1, 5, 5, INFINITY}, {0, 1, 0, 1}), 0.875);
    EXPECT_EQ(Area({}, {}), 0.5);
    EXPECT_EQ(Area({1, 2}, {1, 1}), 0.5);
    EXPECT_THROW(Area({1, 2}, {1}), std::invalid_argument);
    EXPECT_THROW(Area({1, NAN}, {1, 0}), std::invalid_argument);
}

TEST(AreaUnderRoc, IsWhatItsDefinitionSays) {
    std::mt19937 generator(1);
    std::vector<float> scores;
    std::vector<char> labels;
    for (int i = 0; i < 200; ++i) {
        scores.push_back(float(generator() % 20));
        labels.push_back(generator() % 3 == 0);
    }
    double right = 0, pairs = 0;
    for (size_t i = 0; i < scores.size(); ++i)
        for (size_t j = 0; j < scores.size(); ++j)
            if (labels[i] && !labels[j]) {
                ++pairs;
                right += scores[i] > scores[j] ? 1 : scores[i] == scores[j] ? 0.5 : 0;
            }
    EXPECT_NEAR(Area(scores, labels), right / pairs, 1e-12);
}

}  // namespace

}  // namespace lull
