#include "stopping/features/window.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <stdexcept>
#include <string>

#include "stopping/signals/ladder.h"

namespace lull {

Eigen::ArrayXd Normalize(const Eigen::ArrayXd& values) {
    const double min = values.minCoeff(), max = values.maxCoeff();
    return (values - min) / (max - min + std::numeric_limits<double>::epsilon());
}

FeatureHistory::FeatureHistory(const ModelSettings& settings)
    : settings(settings), ranges(InputRanges(settings)), inputs(InputCount(settings)) {
    CheckSettings(settings);
}

void FeatureHistory::Add(int spp, std::span<const double> feature) {
    if (feature.size() != size_t(inputs))
        throw std::invalid_argument("a feature of " + std::to_string(inputs) + " values is needed");
    if (!std::all_of(feature.begin(), feature.end(), [](double v) { return std::isfinite(v); }))
        throw std::invalid_argument("a feature is NaN or infinite");
    if (spp < 1 || (!entries.empty() && spp <= entries.back().spp))
        throw std::invalid_argument("features must come with increasing spp");

    if (settings.spacing == Spacing::Geometric) {
        AddToLadder(Entry{spp, {feature.begin(), feature.end()}},
                    std::pow(settings.ratio, settings.k - 1), &entries);
        return;
    }
    // Forget what has left the window of this and all later spp.
    const int64_t oldest = int64_t(spp) - int64_t(settings.k - 1) * settings.n;
    std::erase_if(entries, [&](const Entry& e) { return e.spp < oldest; });
    entries.push_back({spp, {feature.begin(), feature.end()}});
}

const std::vector<double>* FeatureHistory::FindStep(int spp, int stepsBefore) const {
    if (settings.spacing == Spacing::Fixed) {
        const int64_t at = int64_t(spp) - int64_t(stepsBefore) * settings.n;
        return at > 0 ? Find(int(at)) : nullptr;
    }
    if (entries.empty() || entries.back().spp != spp) return nullptr;
    if (stepsBefore == 0) return &entries.back().feature;
    // So near that no step is nearer to another place of the window.
    const Entry* entry = FindInLadder(entries, spp / std::pow(settings.ratio, stepsBefore),
                                      std::sqrt(settings.ratio), true);
    return entry ? &entry->feature : nullptr;
}

const std::vector<double>* FeatureHistory::Find(int spp) const {
    const auto it = std::lower_bound(entries.begin(), entries.end(), spp,
                                     [](const Entry& e, int s) { return e.spp < s; });
    return it != entries.end() && it->spp == spp ? &it->feature : nullptr;
}

void FeatureHistory::NormalizeRange(Eigen::Ref<Eigen::ArrayXXd> window) const {
    if (settings.bnorm)
        for (int step = 0; step < settings.k; ++step)
            window.col(step) = Normalize(window.col(step));
    if (settings.snorm)
        for (Eigen::Index i = 0; i < window.rows(); ++i)
            window.row(i) = Normalize(window.row(i).transpose()).transpose();
}

std::optional<Eigen::MatrixXf> FeatureHistory::WindowAt(int spp) const {
    Eigen::ArrayXXd window(inputs, settings.k);
    for (int step = 0; step < settings.k; ++step) {
        const std::vector<double>* feature = FindStep(spp, settings.k - 1 - step);
        if (!feature) return {};
        window.col(step) = Eigen::Map<const Eigen::ArrayXd>(feature->data(), inputs);
    }
    // Normalise in double: late in a rendering the values of a window differ by little.
    for (const InputRange& range : ranges)
        if (IsNormalized(range.feature))
            NormalizeRange(window.middleRows(range.begin, range.count));
    return window.matrix().cast<float>();
}

}  // namespace lull
