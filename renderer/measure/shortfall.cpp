#include "renderer/measure/shortfall.h"

#include <algorithm>
#include <cmath>

#include "stopping/rules/rule_table.h"

namespace lull {

namespace {

bool CountsSamples(const std::string& text) {
    const Rule* rule = FindRule(text);
    return rule && rule->compares == RuleTrend::Samples;
}

// Returns the noise of blocks that the rule has stopped.
double NoiseAtStop(const std::vector<BlockResult>& blocks) {
    std::vector<double> noise;
    for (const BlockResult& b : blocks)
        if (b.block.stoppedByVote && std::isfinite(b.block.noise)) noise.push_back(b.block.noise);
    if (noise.empty()) return std::stod(ArgumentOf("lnoise"));
    const auto middle = noise.begin() + noise.size() / 2;
    std::nth_element(noise.begin(), middle, noise.end());
    return *middle;
}

double StopSpp(const BlockResult& result, const std::string& rule, double noiseAtStop) {
    if (!result.decisions.empty()) {
        const Decision& last = result.decisions.back().decision;
        if (CountsSamples(rule)) return last.threshold;
        if (last.visibleNoise) noiseAtStop = last.threshold;
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

double NeededSeconds(const std::vector<NoisyBlock>& blocks, const RenderResult& result) {
    double taken = 0, needed = 0;  // of processors
    for (const BlockResult& b : result.blocks) taken += b.seconds + b.criterionSeconds;
    for (const NoisyBlock& block : blocks) needed += block.neededSeconds;
    return taken > 0 ? needed / taken * result.progress.seconds : 0;
}

}  // namespace lull
