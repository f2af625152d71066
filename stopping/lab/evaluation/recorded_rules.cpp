#include "stopping/lab/evaluation/recorded_rules.h"

#include <algorithm>

#include "stopping/lab/recordings/training_samples.h"
#include "stopping/rules/denoised.h"
#include "stopping/rules/lnoise.h"

namespace lull {

namespace {

constexpr double kNoiseLevels[] = {8, 4, 2, 1, 0.7, 0.5, 0.35, 0.25};
constexpr double kDammertzErrors[] = {0.32, 0.16, 0.08, 0.04, 0.02, 0.01, 0.005, 0.0025};
constexpr double kCyclesErrors[] = {0.64, 0.32, 0.16, 0.08, 0.04, 0.02, 0.01, 0.005};
constexpr double kLuxErrors[] = {0.5, 0.35, 0.25, 0.18, 0.12, 0.08, 0.04, 0.02};

constexpr RecordedRule kRules[] = {{.name = "learned", .replay = Replay::Decides},
                                   {.name = "entropy",
                                    .replay = Replay::Decides,
                                    .curve = kNoiseLevels,
                                    .largest = 50,
                                    .least = 0.01},
                                   {.name = "dammertz",
                                    .replay = Replay::Decides,
                                    .channel = "dammertz",
                                    .curve = kDammertzErrors,
                                    .largest = 1,
                                    .least = 1e-4},
                                   {.name = "cycles",
                                    .replay = Replay::RanAlong,
                                    .curve = kCyclesErrors,
                                    .largest = kCyclesThresholds.front(),
                                    .least = kCyclesThresholds.back()},
                                   {.name = "luxtile",
                                    .replay = Replay::Decides,
                                    .channel = "luxtile",
                                    .curve = kLuxErrors,
                                    .largest = 1,
                                    .least = 1e-4},
                                   {.name = kLightnessNoiseName,
                                    .replay = Replay::Decides,
                                    .channel = "masked_noise",
                                    .curve = kNoiseLevels,
                                    .largest = 50,
                                    .least = 0.01},
                                   {.name = kDenoisedRuleName, .replay = Replay::Unknown},
                                   {.name = "thresholds", .replay = Replay::Counts},
                                   {.name = "fixed", .replay = Replay::Counts}};

}  // namespace

std::span<const RecordedRule> RecordedRules() { return kRules; }

const RecordedRule* FindRecordedRule(std::string_view text) {
    const auto rule = std::ranges::find(
        kRules, text.substr(0, std::min(text.find(':'), text.size())), &RecordedRule::name);
    return rule == std::end(kRules) ? nullptr : rule;
}

bool HasRecordedSignals(const Rule& rule) {
    if (rule.inputs) return true;
    const RecordedRule* entry = FindRecordedRule(rule.text);
    // How large the image was, which that rule needs, recordings do not know.
    return entry && entry->channel && !rule.text.ends_with(":area");
}

Signals RecordedSignals(const Rule& rule, const BlockRecording& recording, int i) {
    if (rule.inputs) return MeasuresOf(recording, i, *rule.inputs);
    return PooledRms(recording.Values(i, FindRecordedRule(rule.text)->channel));
}

}  // namespace lull
