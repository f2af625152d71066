#include "stopping/lab/evaluation/evaluation.h"

#include <Eigen/Cholesky>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <numeric>
#include <random>
#include <stdexcept>
#include <vector>

namespace lull {

namespace {

constexpr int kPassSpp = 20;  // of the human data

double MeanOf(const std::vector<double>& values) {
    return std::accumulate(values.begin(), values.end(), 0.0) / double(values.size());
}

struct Verdicts {
    std::vector<float> scores;
    std::vector<char> labels;                      // whether people see noise
    std::array<double, 2> count = {}, right = {};  // by label

    void Add(const BlockOutcome& block) {
        for (const BlockVerdict& v : block.outcome.verdicts) {
            const bool noisy = block.human > v.spp;
            scores.push_back(float(v.score));
            labels.push_back(noisy);
            ++count[noisy];
            right[noisy] += v.noisy == noisy;
        }
    }
};

void AddMeans(const ViewpointOutcome& viewpoint, const ScoreOptions& options, Scores* sums) {
    double error = 0, early = 0, late = 0;
    for (const BlockOutcome& block : viewpoint.blocks) {
        const double stop = block.outcome.stop, human = block.human;
        error += std::abs(stop - human);
        early += stop < 0.8 * human;
        late += stop > 1.25 * human;
    }
    const double count = double(viewpoint.blocks.size());
    sums->absoluteError += error / count;
    sums->early += early / count;
    sums->late += late / count;
    for (size_t i = 0; i < options.margins.size(); ++i)
        sums->criticalErrors[i] +=
            CriticalError(viewpoint.blocks, options.margins[i], options.grid);
}

std::vector<std::vector<double>> ErrorsOfBlocks(std::span<const ViewpointOutcome> viewpoints,
                                                double margin, int grid) {
    std::vector<std::vector<double>> errors;
    for (const ViewpointOutcome& viewpoint : viewpoints) {
        if (viewpoint.blocks.empty()) continue;
        std::vector<double>& row = errors.emplace_back();
        for (const BlockOutcome& block : viewpoint.blocks)
            row.push_back(CriticalError(std::span(&block, 1), margin, grid));
    }
    return errors;
}

void AddRankCorrelations(std::span<const ViewpointOutcome> viewpoints, Scores* scores) {
    std::vector<double> meanStops, meanHumans, within;
    for (const ViewpointOutcome& viewpoint : viewpoints) {
        if (viewpoint.blocks.empty()) continue;
        std::vector<double> stops, humans;
        for (const BlockOutcome& block : viewpoint.blocks) {
            stops.push_back(block.outcome.stop);
            humans.push_back(block.human);
        }
        meanStops.push_back(MeanOf(stops));
        meanHumans.push_back(MeanOf(humans));
        if (const auto rank = RankCorrelation(stops, humans)) within.push_back(*rank);
    }
    if (!within.empty()) scores->rankWithin = MeanOf(within);
    scores->rankBetween = RankCorrelation(meanStops, meanHumans);
}

}  // namespace

std::string LabelOf(const EvaluatedRule& rule) {
    if (rule.openStops == OpenStops::None) return rule.name;
    return rule.name + (rule.openStops == OpenStops::Ends ? ", at least" : ", extended");
}

RuleOutcome OutcomeOfStop(int stop, int grid) {
    RuleOutcome outcome{.stop = stop};
    for (int x = kPassSpp; x <= kMostShownSpp; x += grid)
        outcome.verdicts.push_back({.spp = x, .score = double(stop) / x, .noisy = stop > x});
    return outcome;
}

double CriticalError(std::span<const BlockOutcome> blocks, double margin, int grid) {
    // The paper's passes of 20 spp and cap of 10,000 make this 20 floor(500 M / 200).
    const int half = kPassSpp * int(std::floor(kMostShownSpp / kPassSpp * margin / 200));
    int64_t wrong = 0, count = 0;
    for (const BlockOutcome& block : blocks) {
        const bool never = block.human >= kMostShownSpp;
        const int lo = never ? kMostShownSpp : block.human - half;
        const int hi = never ? kMostShownSpp : block.human + half;
        const int stop = block.outcome.stop;
        for (int x = kPassSpp; x <= kMostShownSpp; x += grid, ++count)
            wrong += !((x <= lo && x <= stop) || (x >= hi && x >= stop) || (lo < x && x < hi));
    }
    return count > 0 ? double(wrong) / double(count) : 0;
}

Scores Score(std::span<const ViewpointOutcome> viewpoints, const ScoreOptions& options) {
    Scores result;
    result.criticalErrors.assign(options.margins.size(), 0);
    Verdicts verdicts;
    for (const ViewpointOutcome& viewpoint : viewpoints) {
        if (viewpoint.blocks.empty()) continue;
        ++result.viewpoints;
        result.blocks += int(viewpoint.blocks.size());
        AddMeans(viewpoint, options, &result);
        for (const BlockOutcome& block : viewpoint.blocks) {
            result.open += block.outcome.open;
            result.seen += block.seen;
            verdicts.Add(block);
        }
    }
    if (!options.margins.empty() && result.blocks > 0)
        result.criticalInterval =
            BootstrapInterval(ErrorsOfBlocks(viewpoints, options.margins[0], options.grid));
    AddRankCorrelations(viewpoints, &result);
    const double count = std::max(1, result.viewpoints);
    for (double& error : result.criticalErrors) error /= count;
    result.absoluteError /= count;
    result.early /= count;
    result.late /= count;
    if (verdicts.count[0] > 0 && verdicts.count[1] > 0) {
        result.auc = AreaUnderRoc(verdicts.scores, verdicts.labels);
        result.accuracy =
            (verdicts.right[0] / verdicts.count[0] + verdicts.right[1] / verdicts.count[1]) / 2;
    }
    return result;
}

namespace {

constexpr int kDraws = 2000;
constexpr unsigned kSeed = 1;

// Returns a number below `count`; the same everywhere, unlike std::uniform_int_distribution.
size_t Draw(std::mt19937& generator, size_t count) {
    return size_t(uint64_t(generator()) * count >> 32);
}

}  // namespace

Interval BootstrapInterval(std::span<const std::vector<double>> values) {
    if (values.empty() || std::ranges::any_of(values, &std::vector<double>::empty))
        throw std::invalid_argument("bootstrap: viewpoints with blocks are needed");
    std::mt19937 generator(kSeed);
    std::vector<double> means;
    for (int draw = 0; draw < kDraws; ++draw) {
        double mean = 0;
        for (size_t v = 0; v < values.size(); ++v) {
            const std::vector<double>& blocks = values[Draw(generator, values.size())];
            double sum = 0;
            for (size_t i = 0; i < blocks.size(); ++i)
                sum += blocks[Draw(generator, blocks.size())];
            mean += sum / double(blocks.size()) / double(values.size());
        }
        means.push_back(mean);
    }
    std::ranges::sort(means);
    return {means[kDraws / 40], means[kDraws - 1 - kDraws / 40]};
}

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

namespace {

// Returns twice the rank of each number less their mean, so that all are whole numbers.
std::vector<double> CentredRanks(std::span<const double> values) {
    std::vector<double> ranks;
    for (const double v : values) {
        if (std::isnan(v)) throw std::invalid_argument("rank correlation: not a number");
        double rank = 0;
        for (const double other : values) rank += (other < v) - (other > v);
        ranks.push_back(rank);
    }
    return ranks;
}

double Product(const std::vector<double>& a, const std::vector<double>& b) {
    double sum = 0;
    for (size_t i = 0; i < a.size(); ++i) sum += a[i] * b[i];
    return sum;
}

}  // namespace

std::optional<double> RankCorrelation(std::span<const double> a, std::span<const double> b) {
    if (a.size() != b.size())
        throw std::invalid_argument("rank correlation: the lengths of both sides differ");
    const std::vector<double> x = CentredRanks(a), y = CentredRanks(b);
    const double scale = std::sqrt(Product(x, x) * Product(y, y));
    if (a.size() < 3 || scale == 0) return std::nullopt;
    return Product(x, y) / scale;
}

double AreaUnderRoc(std::span<const float> scores, std::span<const char> labels) {
    if (scores.size() != labels.size())
        throw std::invalid_argument("there must be one label for each score");
    if (std::any_of(scores.begin(), scores.end(), [](float s) { return std::isnan(s); }))
        throw std::invalid_argument("a score is NaN");
    std::vector<size_t> order(scores.size());
    std::iota(order.begin(), order.end(), size_t(0));
    std::sort(order.begin(), order.end(),
              [&](size_t a, size_t b) { return scores[a] < scores[b]; });

    // Count the pairs with the right order, group by group of equal scores.
    double pairs = 0, zeros = 0, ones = 0;
    for (size_t i = 0; i < order.size();) {
        double zerosHere = 0, onesHere = 0;
        const float score = scores[order[i]];
        for (; i < order.size() && scores[order[i]] == score; ++i)
            ++(labels[order[i]] ? onesHere : zerosHere);
        pairs += onesHere * (zeros + zerosHere / 2);
        zeros += zerosHere;
        ones += onesHere;
    }
    return zeros > 0 && ones > 0 ? pairs / (zeros * ones) : 0.5;
}

}  // namespace lull
