// Compares the stops of a rule, and its earlier verdicts, with human thresholds.
#pragma once

#include <Eigen/Core>

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "stopping/lab/recordings/recording.h"

namespace lull {

// Statistics of evaluations.

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

// Fits the probability of a yes, the distribution function of the normal distribution at `rows` *
// coefficients, to answers of 0 and 1, one a row. Where answers can be told apart without an error
// coefficients are large, and the likelihood is within 1e-6 of its supremum. Throws
// std::invalid_argument for no rows, wrong sizes and numbers that are not finite. Each answer
// counts as so many as its weight, > 0, says; without weights as one.
ProbitFit FitProbit(const Eigen::MatrixXd& rows, const Eigen::VectorXd& answers,
                    const Eigen::VectorXd& weights = {});

// Returns Spearman's rank correlation of pairs of numbers, in [-1, 1]; equal numbers share the mean
// of their ranks. Nothing where there are fewer than three pairs, or all numbers of one side are
// the same. Throws std::invalid_argument if the lengths differ or a number is NaN.
std::optional<double> RankCorrelation(std::span<const double> a, std::span<const double> b);

// Measures how well numbers tell two classes apart.

// Returns the area under the curve of the receiver operating characteristic: the probability that a
// sample with the label 1 has a higher score than one with 0; equal scores count one half. 0.5 if
// there are no two classes. Throws std::invalid_argument if lengths differ or for NaN.
double AreaUnderRoc(std::span<const float> scores, std::span<const char> labels);

struct BlockVerdict {
    int spp = 0;
    double score = 0;  // the larger, the noisier; comparable between blocks; may be infinite
    bool noisy = false;
};

struct RuleOutcome {
    int stop = 0;  // spp; kMostShownSpp where it never stopped
    // Whether the recording ends below the cap and the rule had not stopped the block there: it
    // stops at the end then or, on a recording that was extended, beyond it.
    bool open = false;
    std::vector<BlockVerdict> verdicts = {};
};

// Returns the outcome of which only the stop is known: noisy below it at the spp 20, 20 + grid, ...
// up to the cap, with the score stop / spp.
RuleOutcome OutcomeOfStop(int stop, int grid);

struct BlockOutcome {
    int human = 0;  // the threshold of people in spp, kMostShownSpp where they saw noise even there
    RuleOutcome outcome = {};
    int block = 0;      // row-major number in the image
    bool seen = false;  // whether the rule is a model that was trained on it
};
struct ViewpointOutcome {
    std::string name;
    std::string setting = {};  // of the rule, for tables
    std::vector<BlockOutcome> blocks = {};
};

// Where blocks stop that a rule had not stopped where their recordings end.
enum class OpenStops {
    None,     // there are no such blocks
    Ends,     // at these ends, although the rule continues
    Extended  // where the rule stops on extrapolated recordings (extension.h)
};

// The outcomes of a rule, or of the thresholds in a file.
struct EvaluatedRule {
    std::string name;
    std::string setting = {};  // the one for all viewpoints, if there is one
    std::vector<ViewpointOutcome> viewpoints = {};
    // of its number, the score of verdicts; 0: it has none
    double threshold = 0;
    OpenStops openStops = OpenStops::None;
};

// Returns the name for tables: "NAME, at least" and "NAME, extended" where blocks are open.
std::string LabelOf(const EvaluatedRule& rule);

// Returns the critical error of one viewpoint (paper, Table 3), in [0, 1]: over its blocks and the
// spp x = 20, 20 + grid, ... up to kMostShownSpp, the share of x at which the stop S is wrong. With
// the human threshold T and a margin of `margin` % of the cap in all, lo and hi are half the margin
// below and above T, in whole passes of 20 spp, but T itself where T is the cap; x is right if
// x <= lo and x <= S, x >= hi and x >= S, or lo < x < hi. 0 for no blocks.
double CriticalError(std::span<const BlockOutcome> blocks, double margin, int grid);

struct ScoreOptions {
    int grid = 40;                             // spp, > 0
    std::vector<double> margins = {2, 6, 10};  // % of the cap
};

// The measures of some viewpoints. Shares are in [0, 1].
struct Scores {
    int viewpoints = 0, blocks = 0, seen = 0, open = 0;
    // Means over the viewpoints of the means over their blocks:
    std::vector<double> criticalErrors = {};  // for each margin
    double absoluteError = 0;                 // |stop - human| in spp
    double early = 0, late = 0;               // shares with stop < 80 %, > 125 % of human
    // Confidence interval of the critical error at the first margin for other viewpoints and blocks
    // (BootstrapInterval()); nothing without margins or blocks.
    std::optional<Interval> criticalInterval = {};
    // Rank correlation of stops and human thresholds: of blocks within a viewpoint, in the mean of
    // those where both differ, and of the means of the viewpoints.
    std::optional<double> rankWithin = {}, rankBetween = {};
    // Of all verdicts together, against noise seen below the human threshold; nothing where all
    // verdicts are on one side of it. The accuracy is the mean of both classes'.
    std::optional<double> auc, accuracy;
};
Scores Score(std::span<const ViewpointOutcome> viewpoints, const ScoreOptions& options);

}  // namespace lull
