#include "stopping/features/recorded_measures.h"

#include <stdexcept>
#include <string>
#include <vector>

namespace lull {

namespace {

const char* const needed = ": recordings have H for m = 4, 25, 100 and 400, H1 and H2 for m = 100";

std::string EntropyChannel(Feature feature, int m) {
    if (feature == Feature::H && (m == 4 || m == 25 || m == 100 || m == 400))
        return std::string("h").append(std::to_string(m));
    if (feature == Feature::H1 && m == 100) return "h1";
    if (feature == Feature::H2 && m == 100) return "h2";
    throw std::invalid_argument(FeatureNames({&feature, 1}) + " with m = " + std::to_string(m) +
                                needed);
}

}  // namespace

SubBlockLightness RecordedLightness(const RecordedValues& values) {
    const std::span<const float> mean = values("lightness"), deviation = values("deviation");
    return {.mean = {mean.begin(), mean.end()}, .deviation = {deviation.begin(), deviation.end()}};
}

BlockMeasures RecordedMeasures(int spp, const RecordedValues& values,
                               const ModelSettings& settings) {
    BlockMeasures measures{.spp = spp};
    const auto put = [&](Feature feature, std::string_view channel) {
        const std::span<const float> numbers = values(channel);
        measures.Of(feature).assign(numbers.begin(), numbers.end());
    };
    for (const Feature feature : settings.features) {
        if (feature == Feature::VisibleDrop) {
            put(Feature::H, EntropyChannel(Feature::H, settings.m));
            measures.lightness = RecordedLightness(values);
        } else if (IsEntropy(feature)) {
            put(feature, EntropyChannel(feature, settings.m));
        } else {
            put(feature, FeatureNames({&feature, 1}));  // which is that of its channel
        }
    }
    return measures;
}

}  // namespace lull
