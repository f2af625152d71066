#include "stopping/features/model_inputs.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <stdexcept>

#include "stopping/signals/attributes26.h"
#include "stopping/signals/lightness.h"
#include "stopping/signals/lightness_noise.h"
#include "stopping/signals/svd_entropy.h"

namespace lull {

namespace {

// Whether an entropy is asked for, or its fall.
bool NeedsEntropy(const ModelSettings& settings, Feature entropy) {
    return std::ranges::any_of(settings.features, [&](Feature f) {
        return f == entropy || (f == Feature::VisibleDrop && entropy == Feature::H);
    });
}

bool NeedsEntropies(const ModelSettings& settings) {
    return Needs(settings, Feature::VisibleDrop) ||
           std::ranges::any_of(settings.features, IsEntropy);
}

// Measures the features of the display image.
void MeasureDisplayed(const BlockView& view, const ModelSettings& settings,
                      BlockMeasures* measures) {
    if (Needs(settings, Feature::Attributes26)) {
        const auto attributes = ComputeAttributes(LightnessOf(view.mean), view.width, view.height);
        measures->Of(Feature::Attributes26).assign(attributes.begin(), attributes.end());
    }
    if (!NeedsEntropies(settings)) return;
    for (const SvdEntropy& e : PictureEntropies(view, settings.m)) {
        if (NeedsEntropy(settings, Feature::H)) measures->Of(Feature::H).push_back(e.h);
        if (NeedsEntropy(settings, Feature::H1)) measures->Of(Feature::H1).push_back(e.h1);
        if (NeedsEntropy(settings, Feature::H2)) measures->Of(Feature::H2).push_back(e.h2);
    }
}

void MeasureStatistics(const BlockView& view, BlockMeasures* measures) {
    const LightnessNoiseStatistics s = SubBlockStatistics(ComputeLightnessNoise(view), view.width,
                                                          view.height, kMeasuredSubBlocks);
    measures->Of(Feature::DetailMaskedNoise) =
        DetailMaskedNoise(s.halfNoise, s.deviation, s.texture);
}

int ValueCount(const ModelSettings& settings, Feature feature) {
    if (feature == Feature::Attributes26) return kAttributes;
    return IsEntropy(feature) ? settings.m : kMeasuredSubBlocks;
}

double Pooled(const Pool& pool, const std::vector<double>& values) {
    const Eigen::Map<const Eigen::ArrayXd> v(values.data(), Eigen::Index(values.size()));
    return pool.exponent == 1 ? v.mean()
                              : std::pow(v.abs().pow(pool.exponent).mean(), 1.0 / pool.exponent);
}

// Returns the constant added to noise before its logarithm is taken.
double LeastNoise(Feature feature) { return feature == Feature::VisibleDrop ? 0.1 : 0.001; }

// Brings values near the unit interval, or to where differences mean the same everywhere.
double Scaled(Feature feature, double value) {
    if (IsNormalized(feature)) return value;
    return std::log(std::max(value, 0.0) + LeastNoise(feature));
}

}  // namespace

ViewNeed NeedOf(const ModelSettings& settings) {
    return Needs(settings, Feature::DetailMaskedNoise) ? ViewNeed::MeanAndHalf : ViewNeed::Mean;
}

BlockMeasures MeasureBlock(const BlockView& view, const ModelSettings& settings) {
    CheckView(view, NeedOf(settings));
    BlockMeasures measures{.spp = view.spp};
    MeasureDisplayed(view, settings, &measures);
    if (Needs(settings, Feature::DetailMaskedNoise)) MeasureStatistics(view, &measures);
    if (Needs(settings, Feature::VisibleDrop))
        measures.lightness = MeasureLightness(view, kMeasuredSubBlocks);
    return measures;
}

std::vector<InputRange> InputRanges(const ModelSettings& settings) {
    std::vector<InputRange> ranges;
    int begin = 0;
    for (Feature feature : settings.features) {
        const bool pooled = !settings.pools.empty() && HasSubBlocks(feature);
        const int count = pooled ? int(settings.pools.size()) : ValueCount(settings, feature);
        ranges.push_back({feature, begin, count});
        begin += count;
    }
    return ranges;
}

int InputCount(const ModelSettings& settings) {
    int count = 0;
    for (const InputRange& range : InputRanges(settings)) count += range.count;
    return count;
}

std::vector<double> InputVector(const BlockMeasures& measures, const ModelSettings& settings) {
    std::vector<double> inputs;
    for (Feature feature : settings.features) {
        const std::vector<double>& values = measures.Of(feature);
        if (values.size() != size_t(ValueCount(settings, feature)))
            throw std::invalid_argument("the measures of " + FeatureNames({&feature, 1}) +
                                        " do not have as many values as there must be");
        const double factor = IsNoise(feature) ? settings.caution : 1;
        if (settings.pools.empty() || !HasSubBlocks(feature)) {
            for (double v : values) inputs.push_back(Scaled(feature, factor * v));
            continue;
        }
        for (const Pool& pool : settings.pools)
            inputs.push_back(Scaled(feature, factor * Pooled(pool, values)));
    }
    return inputs;
}

bool LooksAtNoiseOnly(const ModelSettings& settings) {
    return settings.features.size() == 1 && IsNoise(settings.features[0]) &&
           InputCount(settings) == 1;
}

double InputOfNoise(double noise, const ModelSettings& settings) {
    return Scaled(settings.features.at(0), noise);
}

double NoiseOfInput(double input, const ModelSettings& settings) {
    return std::max(0.0, std::exp(input) - LeastNoise(settings.features.at(0)));
}

}  // namespace lull
