#include "stopping/lab/evaluation/constants.h"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

namespace lull {

namespace {

constexpr int kStep = 20;  // spp between constants

int SppOf(size_t constant) { return kStep * int(constant + 1); }

// Returns the viewpoint as it is where all of its blocks stop at one spp; without verdicts if
// `brief`.
ViewpointOutcome StoppedAt(const ViewpointOutcome& viewpoint, int spp, int grid, bool brief) {
    ViewpointOutcome result{.name = viewpoint.name, .setting = fmt::format("{}", spp)};
    for (const BlockOutcome& block : viewpoint.blocks)
        result.blocks.push_back(
            {.human = block.human,
             .outcome = brief ? RuleOutcome{.stop = spp} : OutcomeOfStop(spp, grid),
             .block = block.block});
    return result;
}

std::vector<double> CostsOf(const ViewpointOutcome& viewpoint, ChooseBy chooseBy, int grid) {
    std::vector<double> costs;
    for (size_t i = 0; SppOf(i) <= kMostShownSpp; ++i)
        costs.push_back(CostOf(StoppedAt(viewpoint, SppOf(i), grid, true), chooseBy, grid));
    return costs;
}

// Returns the spp of the least sum of costs, the first among equals.
int BestOf(const std::vector<double>& costs) {
    return SppOf(size_t(std::ranges::min_element(costs) - costs.begin()));
}

}  // namespace

std::vector<EvaluatedRule> EvaluateConstants(std::span<const ViewpointOutcome> viewpoints,
                                             ChooseBy chooseBy, int grid) {
    if (viewpoints.empty()) throw std::invalid_argument("constants: there is no viewpoint");
    std::vector<std::vector<double>> costs;
    std::vector<double> all(kMostShownSpp / kStep, 0);
    for (const ViewpointOutcome& viewpoint : viewpoints) {
        costs.push_back(CostsOf(viewpoint, chooseBy, grid));
        for (size_t i = 0; i < all.size(); ++i) all[i] += costs.back()[i];
    }
    EvaluatedRule known{.name = "constant, known"}, others{.name = "constant, of others"},
        one{.name = "constant", .setting = fmt::format("{}", BestOf(all))};
    for (size_t v = 0; v < viewpoints.size(); ++v) {
        std::vector<double> rest = all;
        for (size_t i = 0; i < rest.size(); ++i) rest[i] -= costs[v][i];
        const auto add = [&](int spp, EvaluatedRule* rule) {
            rule->viewpoints.push_back(StoppedAt(viewpoints[v], spp, grid, false));
        };
        add(BestOf(costs[v]), &known);
        add(BestOf(rest), &others);
        add(BestOf(all), &one);
    }
    if (viewpoints.size() < 2) return {known, one};
    return {known, others, one};
}

}  // namespace lull
