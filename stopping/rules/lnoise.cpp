#include "stopping/rules/lnoise.h"

#include <cmath>
#include <cstdint>

#include "stopping/rules/rule.h"
#include "stopping/signals/lightness_noise.h"

namespace lull {

namespace {

constexpr uint32_t kLightnessNoiseTag = 0x324e534c;  // "LSN2"
constexpr int kSubBlocks = 100;

}  // namespace

double PooledRms(std::span<const float> subBlocks) {
    double sum = 0;
    for (float rms : subBlocks) sum += double(rms) * rms;
    return std::sqrt(sum / double(subBlocks.size()));
}

double VisibleNoise(const BlockView& view) {
    const LightnessNoise noise = ComputeLightnessNoise(view);
    return PooledRms(SubBlockStatistics(noise, view.width, view.height, kSubBlocks).maskedNoise);
}

Rule LightnessNoiseRule(double threshold) {
    return {.tag = kLightnessNoiseTag,
            .threshold = threshold,
            .votes = 3,
            .measure = [](const BlockView& view, const BlockInfo&) { return VisibleNoise(view); }};
}

Rule ReadLightnessNoise(const std::string& argument, const RuleContext& context) {
    Rule rule = LightnessNoiseRule(ParseThreshold(argument) / context.caution);
    rule.peak.most = kPeakOverThreshold * rule.threshold;
    return rule;
}

namespace {

constexpr uint32_t kTag = 0x34534e44;  // "DNS4"
constexpr int kVotes = 1;
constexpr int kFirstSpp = 20;
constexpr double kGrowth = 1.25;

}  // namespace

Rule ReadDenoised(const std::string& argument, const RuleContext& context) {
    return {.tag = kTag,
            .checks = {.first = kFirstSpp, .growth = kGrowth},
            .threshold = ParseThreshold(argument) / context.caution,
            .votes = kVotes,
            .need = ViewNeed::Measured,
            .measure = SuppliedMeasure(context, kDenoisedRuleName)};
}

}  // namespace lull
