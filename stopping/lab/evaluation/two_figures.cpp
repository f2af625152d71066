#include "stopping/lab/evaluation/two_figures.h"

namespace lull {

namespace {

bool HasOpen(const EvaluatedRule& rule) {
    for (const ViewpointOutcome& viewpoint : rule.viewpoints)
        for (const BlockOutcome& block : viewpoint.blocks)
            if (block.outcome.open) return true;
    return false;
}

// Marks the stops that lie beyond the ends of recordings. Outcomes are in the order of the blocks.
void MarkOpen(std::span<const LabelledBlock> blocks, EvaluatedRule* rule) {
    size_t next = 0;
    for (ViewpointOutcome& viewpoint : rule->viewpoints)
        for (BlockOutcome& block : viewpoint.blocks) {
            const int end = blocks[next++].recording->spp.back();
            block.outcome.open = end < kMostShownSpp && block.outcome.stop > end;
        }
}

}  // namespace

void AddTwoFigures(std::span<const LabelledBlock> blocks, EvaluatedRule recorded,
                   const std::function<EvaluatedRule()>& extend,
                   std::vector<EvaluatedRule>* rules) {
    if (!HasOpen(recorded)) {
        rules->push_back(std::move(recorded));
        return;
    }
    recorded.openStops = OpenStops::Ends;
    rules->push_back(std::move(recorded));
    EvaluatedRule extended = extend();
    MarkOpen(blocks, &extended);
    extended.openStops = OpenStops::Extended;
    rules->push_back(std::move(extended));
}

}  // namespace lull
