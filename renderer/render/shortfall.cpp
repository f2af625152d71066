#include "renderer/render/shortfall.h"

#include <algorithm>
#include <cmath>

#include "renderer/progress/forecast.h"
#include "stopping/rules/baselines.h"
#include "stopping/rules/rule_table.h"

namespace lull {

namespace {

double NoiseAtStop(const std::vector<BlockResult>& blocks) {
    std::vector<double> noise;
    for (const BlockResult& b : blocks)
        if (b.block.stoppedByVote && std::isfinite(b.block.noise)) noise.push_back(b.block.noise);
    if (noise.empty()) return std::stod(ArgumentOf(kLightnessNoiseName));
    const auto middle = noise.begin() + noise.size() / 2;
    std::nth_element(noise.begin(), middle, noise.end());
    return *middle;
}

double StopSpp(const BlockResult& result, const std::string& rule, double noiseAtStop) {
    if (!result.decisions.empty()) {
        const Decision& last = result.decisions.back().decision;
        const RuleEntry* entry = FindRule(rule);
        if (entry && entry->compares == RuleTrend::Samples) return last.threshold;
        if (entry && entry->name == kLightnessNoiseName) noiseAtStop = last.threshold;
    }
    const double ratio = result.block.noise / noiseAtStop;
    return result.block.spp * ratio * ratio;
}

}  // namespace

std::vector<NoisyBlock> FindShortfall(const Provenance& provenance, const RenderResult& result) {
    const auto& [cap, pass] = std::pair(provenance.schedule.cap, provenance.schedule.passLength);
    const double noiseAtStop = NoiseAtStop(result.blocks);
    std::vector<NoisyBlock> noisy;
    for (size_t i = 0; i < result.blocks.size(); ++i) {
        const BlockResult& b = result.blocks[i];
        const Block& block = b.block;
        if (block.stopped || block.spp == 0) continue;
        const double passes = std::ceil(StopSpp(b, provenance.criterion, noiseAtStop) / pass);
        const double spp = std::clamp(passes * pass, double(block.spp) + pass, 1e9);
        const int neededSpp = int(std::min(spp, double(cap)));
        noisy.push_back({int(i), block.noise, neededSpp,
                         (b.seconds + b.criterionSeconds) / block.spp * (neededSpp - block.spp)});
    }
    std::stable_sort(noisy.begin(), noisy.end(),
                     [](const NoisyBlock& a, const NoisyBlock& b) { return a.noise > b.noise; });
    return noisy;
}

std::vector<CappedBlock> FindCapped(const RenderResult& result) {
    const RuleTrend& trend = result.trend;
    constexpr int kMostCap = 1 << 24;
    if (trend.kind == RuleTrend::Samples) return {};
    std::vector<StopTrend> trends(result.blocks.size(), StopTrend(trend));
    std::vector<Block> blocks;
    std::vector<CappedBlock> capped;
    for (size_t i = 0; i < result.blocks.size(); ++i) {
        const auto& decisions = result.blocks[i].decisions;
        for (const BlockDecision& record : decisions)
            trends[i].Add(record.spp, record.decision, record.networkNoise);
        blocks.push_back(result.blocks[i].block);
        Block& block = blocks.back();
        if (!block.IsAtCap() || decisions.empty()) continue;
        block.stopped = false;
        const Decision& last = decisions.back().decision;
        capped.push_back({int(i), last.value, last.threshold, 0});
    }
    if (const auto stops = PredictStops(trends, blocks, kMostCap))
        for (CappedBlock& c : capped) {
            // A prediction no more than its sample count is of a block without a trend.
            const int had = blocks[size_t(c.block)].spp;
            const double spp = std::ceil((*stops)[size_t(c.block)]);
            if (spp < kMostCap && (spp > had || c.value <= c.threshold))
                c.neededSpp = std::max(int(spp), had + 1);
        }
    std::ranges::stable_sort(capped, [](const CappedBlock& a, const CappedBlock& b) {
        return std::pair(a.neededSpp == 0, a.neededSpp) > std::pair(b.neededSpp == 0, b.neededSpp);
    });
    return capped;
}

int CapFor(const std::vector<CappedBlock>& capped, int cap) {
    int needed = cap + 1;
    for (const CappedBlock& c : capped) {
        if (c.neededSpp == 0) return 0;
        needed = std::max(needed, c.neededSpp);
    }
    int unit = 1;
    while (needed / unit >= 100) unit *= 10;
    return (needed + unit - 1) / unit * unit;
}

double NeededSeconds(const std::vector<NoisyBlock>& blocks, const RenderResult& result) {
    double taken = 0, needed = 0;  // of processors
    for (const BlockResult& b : result.blocks) taken += b.seconds + b.criterionSeconds;
    for (const NoisyBlock& block : blocks) needed += block.neededSeconds;
    return taken > 0 ? needed / taken * result.progress.seconds : 0;
}

}  // namespace lull
