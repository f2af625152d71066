#include "stopping/features/model_inputs.h"

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "stopping/base/block_view.h"
#include "stopping/signals/attributes26.h"
#include "stopping/signals/lightness.h"
#include "stopping/signals/svd_entropy.h"

namespace lull {

namespace {

constexpr std::array<std::pair<Feature, const char*>, 5> kFeatureNames = {
    {{Feature::H, "H"},
     {Feature::H1, "H1"},
     {Feature::H2, "H2"},
     {Feature::VisibleDrop, "visible_drop"},
     {Feature::Attributes26, "attributes26"}}};

Feature ParseFeature(const std::string& name) {
    std::string known;
    for (const auto& [feature, text] : kFeatureNames) {
        if (name == text) return feature;
        known += std::string(known.empty() ? "" : ", ") + text;
    }
    throw std::invalid_argument("feature '" + name + "' is not known; there are " + known);
}

}  // namespace

std::string FeatureNames(std::span<const Feature> features) {
    std::string names;
    for (const Feature feature : features)
        names.append(names.empty() ? "" : ",").append(kFeatureNames[size_t(feature)].second);
    return names;
}

std::vector<Feature> ParseFeatures(const std::string& names) {
    std::vector<Feature> list;
    for (size_t begin = 0; begin <= names.size();) {
        const size_t end = std::min(names.find(',', begin), names.size());
        const std::string name = names.substr(begin, end - begin);
        const Feature feature = ParseFeature(name);
        if (std::ranges::find(list, feature) != list.end())
            throw std::invalid_argument("'" + name + "' comes twice in '" + names + "'");
        list.push_back(feature);
        begin = end + 1;
    }
    return list;
}

std::string SpacingName(Spacing spacing) {
    return spacing == Spacing::Fixed ? "fixed" : "geometric";
}

Spacing ParseSpacing(const std::string& name) {
    if (name == "fixed") return Spacing::Fixed;
    if (name == "geometric") return Spacing::Geometric;
    throw std::invalid_argument("spacing '" + name + "' is not known; there are fixed, geometric");
}

bool Needs(const ModelSettings& settings, Feature feature) {
    return std::ranges::find(settings.features, feature) != settings.features.end();
}

void CheckSettings(const ModelSettings& s) {
    auto check = []<typename T>(const char* name, T value, std::type_identity_t<T> least,
                                std::type_identity_t<T> most) {
        if (!(value >= least && value <= most))
            throw std::invalid_argument(std::string(name) + " = " + std::to_string(value) +
                                        " is not in [" + std::to_string(least) + ", " +
                                        std::to_string(most) + "]");
    };
    check("k", s.k, 1, 1000);
    check("n", s.n, 1, 1000000);
    check("m", s.m, 1, kSmallestVotingSide * kSmallestVotingSide);
    check("votes", s.votes, 1, 1000);
    check("vote_spacing", s.voteSpacing, 0, 1000000);
    const int side = int(std::lround(std::sqrt(s.m)));
    if (side * side != s.m)
        throw std::invalid_argument("m = " + std::to_string(s.m) + " is not a square number");
    if (s.spacing == Spacing::Geometric) {
        check("ratio", s.ratio, 1.1, 16);
        check("ratio ^ (k - 1)", std::pow(s.ratio, s.k - 1), 1, 1e6);
    }
    check("mask", s.visibility.mask, 1e-3, 1e9);
    check("flare", s.visibility.flare, 0, 1);
    check("nearness", s.visibility.nearness, 0, 10);
    check("peak_limit", s.peakLimit, 0, 100);
    check("reference", s.visibility.reference, 1, 1 << 30);
    check("caution", s.caution, 1e-3, 1e3);
    if (Needs(s, Feature::VisibleDrop) && s.m != 100)
        throw std::invalid_argument("visible_drop needs m = 100");
    if (s.features.empty()) throw std::invalid_argument("a model needs at least one feature");
}

namespace {

bool NeedsEntropies(const ModelSettings& settings) {
    return Needs(settings, Feature::VisibleDrop) ||
           std::ranges::any_of(settings.features, IsEntropy);
}

void MeasureDisplayed(const BlockView& view, const ModelSettings& settings,
                      BlockMeasures* measures) {
    if (Needs(settings, Feature::Attributes26)) {
        const auto attributes = ComputeAttributes(LightnessOf(view.mean), view.width, view.height);
        measures->Of(Feature::Attributes26).assign(attributes.begin(), attributes.end());
    }
    if (!NeedsEntropies(settings)) return;
    for (const SvdEntropy& e : PictureEntropies(view, settings.m)) {
        measures->Of(Feature::H).push_back(e.h);
        measures->Of(Feature::H1).push_back(e.h1);
        measures->Of(Feature::H2).push_back(e.h2);
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

BlockMemory::BlockMemory(const ModelSettings& settings) : settings(settings) {
    CheckSettings(settings);
}

void BlockMemory::Add(BlockMeasures measures) {
    if (Complete(&measures))
        AddInputs(measures.spp, InputVector(measures, settings), settings, &inputs);
}

bool BlockMemory::Complete(BlockMeasures* measures) {
    if (!Needs(settings, Feature::VisibleDrop)) return true;
    AddEntropies(measures->spp, measures->Of(Feature::H), &entropies);
    std::optional<std::vector<double>> drop =
        LatestVisibleDrop(entropies, measures->lightness, settings.visibility);
    if (drop) measures->Of(Feature::VisibleDrop) = std::move(*drop);
    return drop.has_value();
}

void BlockMemory::Save(StateWriter* writer) const {
    writer->Put(uint32_t(InputCount(settings)));
    inputs.Save(writer);
    entropies.Save(writer);
}

void BlockMemory::Restore(StateReader* reader) {
    const uint32_t count = uint32_t(InputCount(settings));
    if (reader->Get<uint32_t>() != count)
        throw std::runtime_error("the saved state belongs to a model with other inputs");
    inputs.Restore(reader, count);
    entropies.Restore(reader, size_t(settings.m));
}

namespace {

const BlockState<double>* FindStep(const History<double>& history, const ModelSettings& settings,
                                   int spp, int stepsBefore) {
    if (settings.spacing == Spacing::Fixed) {
        const int64_t at = int64_t(spp) - int64_t(stepsBefore) * settings.n;
        return at > 0 ? history.At(int(at)) : nullptr;
    }
    const auto& states = history.States();
    if (states.empty() || states.back().spp != spp) return nullptr;
    if (stepsBefore == 0) return &states.back();
    // So near that no step is nearer to another place of the window.
    return history.Nearest(spp / std::pow(settings.ratio, stepsBefore), std::sqrt(settings.ratio));
}

}  // namespace

Eigen::ArrayXd Normalize(const Eigen::ArrayXd& values) {
    const double min = values.minCoeff(), max = values.maxCoeff();
    return (values - min) / (max - min + std::numeric_limits<double>::epsilon());
}

void AddInputs(int spp, std::vector<double> inputs, const ModelSettings& settings,
               History<double>* history) {
    if (inputs.size() != size_t(InputCount(settings)))
        throw std::invalid_argument("inputs of " + std::to_string(InputCount(settings)) +
                                    " values are needed");
    history->Add({spp, std::move(inputs)});
    if (settings.spacing == Spacing::Geometric)
        history->Thin(std::pow(settings.ratio, settings.k - 1));
    else
        history->ForgetBelow(int64_t(spp) - int64_t(settings.k - 1) * settings.n);
}

std::optional<Eigen::MatrixXf> WindowOf(const History<double>& history,
                                        const ModelSettings& settings, int spp) {
    const int count = InputCount(settings);
    Eigen::ArrayXXd window(count, settings.k);
    for (int step = 0; step < settings.k; ++step) {
        const BlockState<double>* state = FindStep(history, settings, spp, settings.k - 1 - step);
        if (!state) return {};
        window.col(step) = Eigen::Map<const Eigen::ArrayXd>(state->values.data(), count);
    }
    // Normalise in double: late in a rendering the values of a window differ by little.
    for (const InputRange& range : InputRanges(settings))
        if (settings.snorm && IsNormalized(range.feature))
            for (int i = range.begin; i < range.begin + range.count; ++i)
                window.row(i) = Normalize(window.row(i).transpose()).transpose();
    return window.matrix().cast<float>();
}

}  // namespace lull
