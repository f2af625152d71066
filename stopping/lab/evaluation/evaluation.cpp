#include "stopping/lab/evaluation/evaluation.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <numeric>

#include "stopping/lab/evaluation/statistics.h"

namespace lull {

namespace {

constexpr int kPassSpp = 20;  // of the human data

double MeanOf(const std::vector<double>& values) {
    return std::accumulate(values.begin(), values.end(), 0.0) / double(values.size());
}

// Collects verdicts and the observers' verdicts at the same spp.
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

// Returns the critical errors of the blocks, by viewpoint.
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

}  // namespace lull
