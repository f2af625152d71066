#include "stopping/features/model_inputs.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <stdexcept>

#include "stopping/signals/attributes26.h"
#include "stopping/signals/lightness.h"
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

int ValueCount(const ModelSettings& settings, Feature feature) {
    if (feature == Feature::Attributes26) return kAttributes;
    return IsEntropy(feature) ? settings.m : kMeasuredSubBlocks;
}

constexpr double kLeastNoise = 0.1;  // is added to noise before its logarithm is taken

}  // namespace

BlockMeasures MeasureBlock(const BlockView& view, const ModelSettings& settings) {
    CheckView(view, ViewNeed::Mean);
    BlockMeasures measures{.spp = view.spp};
    MeasureDisplayed(view, settings, &measures);
    if (Needs(settings, Feature::VisibleDrop))
        measures.lightness = MeasureLightness(view, kMeasuredSubBlocks);
    return measures;
}

std::vector<InputRange> InputRanges(const ModelSettings& settings) {
    std::vector<InputRange> ranges;
    int begin = 0;
    for (Feature feature : settings.features) {
        const bool isMean = settings.takesMean && HasSubBlocks(feature);
        const int count = isMean ? 1 : ValueCount(settings, feature);
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
        const auto scaled = [&](double value) {
            return IsNoise(feature) ? InputOfNoise(settings.caution * value) : value;
        };
        if (settings.takesMean && HasSubBlocks(feature)) {
            const Eigen::Map<const Eigen::ArrayXd> v(values.data(), Eigen::Index(values.size()));
            inputs.push_back(scaled(v.mean()));
        } else {
            for (const double v : values) inputs.push_back(scaled(v));
        }
    }
    return inputs;
}

bool LooksAtNoiseOnly(const ModelSettings& settings) {
    return settings.features.size() == 1 && IsNoise(settings.features[0]) &&
           InputCount(settings) == 1;
}

double InputOfNoise(double noise) { return std::log(std::max(noise, 0.0) + kLeastNoise); }

double NoiseOfInput(double input) { return std::max(0.0, std::exp(input) - kLeastNoise); }

}  // namespace lull
