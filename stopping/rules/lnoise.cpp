#include "stopping/rules/lnoise.h"

#include <cmath>
#include <cstdint>

#include "stopping/rules/argument.h"
#include "stopping/signals/lightness_noise.h"

namespace lull {

namespace {

constexpr uint32_t lightnessNoiseTag = 0x314e534c;  // "LSN1"
constexpr int subBlocks = 100;

}  // namespace

double PooledRms(std::span<const float> subBlocks) {
    double sum = 0;
    for (float rms : subBlocks) sum += double(rms) * rms;
    return std::sqrt(sum / double(subBlocks.size()));
}

double VisibleNoise(const BlockView& view) {
    const LightnessNoise noise = ComputeLightnessNoise(view);
    return PooledRms(SubBlockStatistics(noise, view.width, view.height, subBlocks).maskedNoise);
}

VotingRule LightnessNoiseRule(double threshold) {
    return {.threshold = threshold,
            .votes = VoteCounter().needed,
            .tag = lightnessNoiseTag,
            .measure = [](const BlockView& view, const BlockInfo&) { return VisibleNoise(view); },
            .recall = [](int, const RecordedValues& values) -> Signals {
                return PooledRms(values("masked_noise"));
            },
            .makeGauge = [](const BlockInfo&) { return MakeMeasuredGauge(); },
            .isVisibleNoise = true};
}

CriterionFactory ReadLightnessNoise(const std::string& argument, const RuleContext& context) {
    return FactoryOf(LightnessNoiseRule(ParseThreshold(argument) / context.caution));
}

}  // namespace lull
