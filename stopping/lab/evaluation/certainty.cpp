#include "stopping/lab/evaluation/certainty.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "stopping/network/human_range.h"

namespace lull {

namespace {

// Returns whether the human threshold is in the range of a stop. A threshold at the cap may be any
// number above.
bool IsInRange(const BlockOutcome& block, std::span<const double> logRatios) {
    const int stop = block.outcome.stop;
    const HumanRange range = RangeOfPeople(stop, stop < kMostShownSpp, logRatios);
    return block.human >= range.low && (!range.high || block.human <= *range.high);
}

}  // namespace

std::vector<double> LogRatioQuantiles(std::span<const ViewpointOutcome> viewpoints) {
    std::vector<std::pair<double, double>> ratios;  // and their weights
    double sum = 0;
    for (const ViewpointOutcome& viewpoint : viewpoints)
        for (const BlockOutcome& block : viewpoint.blocks) {
            const double weight = 1 / double(viewpoint.blocks.size());
            ratios.emplace_back(
                std::log(std::max(1, block.human) / double(std::max(1, block.outcome.stop))),
                weight);
            sum += weight;
        }
    if (ratios.empty()) throw std::invalid_argument("there are no blocks to compare with people");
    std::ranges::sort(ratios);

    // Each ratio stands in the middle of its weight; between them the quantile is linear.
    std::vector<double> quantiles, places;
    double below = 0;
    for (const auto& [ratio, weight] : ratios) {
        places.push_back((below + weight / 2) / sum);
        below += weight;
    }
    for (int i = 0; i < kLogRatios; ++i) {
        const double place = double(i) / (kLogRatios - 1);
        const size_t next = size_t(std::ranges::lower_bound(places, place) - places.begin());
        if (next == 0 || next == places.size()) {
            quantiles.push_back(ratios[next == 0 ? 0 : next - 1].first);
            continue;
        }
        const double share = (place - places[next - 1]) / (places[next] - places[next - 1]);
        quantiles.push_back(std::lerp(ratios[next - 1].first, ratios[next].first, share));
    }
    return quantiles;
}

double RangeCoverage(std::span<const ViewpointOutcome> viewpoints) {
    if (viewpoints.size() < 2)
        throw std::invalid_argument("two viewpoints are needed to judge each by the other");
    double sum = 0;
    for (size_t left = 0; left < viewpoints.size(); ++left) {
        std::vector<ViewpointOutcome> others(viewpoints.begin(), viewpoints.end());
        others.erase(others.begin() + ptrdiff_t(left));
        const std::vector<double> quantiles = LogRatioQuantiles(others);
        double inside = 0;
        for (const BlockOutcome& block : viewpoints[left].blocks)
            inside += IsInRange(block, quantiles);
        sum += inside / double(viewpoints[left].blocks.size());
    }
    return sum / double(viewpoints.size());
}

}  // namespace lull
