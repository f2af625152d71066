#include "stopping/window.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <stdexcept>

#include "stopping/small_blocks.h"

namespace lull {

std::string FeatureName(Feature feature) {
    switch (feature) {
        case Feature::H1:
            return "H1";
        case Feature::H2:
            return "H2";
        default:
            return "H";
    }
}

Feature ParseFeature(const std::string& name) {
    for (Feature feature : {Feature::H, Feature::H1, Feature::H2})
        if (name == FeatureName(feature)) return feature;
    throw std::invalid_argument("feature '" + name + "' is not known; H, H1 and H2 are");
}

void CheckSettings(const ModelSettings& s) {
    auto check = [](const char* name, int value, int least, int most) {
        if (value < least || value > most)
            throw std::invalid_argument(std::string(name) + " = " + std::to_string(value) +
                                        " is not in [" + std::to_string(least) + ", " +
                                        std::to_string(most) + "]");
    };
    check("k", s.k, 1, 1000);
    check("n", s.n, 1, 1000000);
    check("m", s.m, 1, smallestVotingSide * smallestVotingSide);
    check("votes", s.votes, 1, 1000);
    check("vote_spacing", s.voteSpacing, 0, 1000000);
    const int side = int(std::lround(std::sqrt(s.m)));
    if (side * side != s.m)
        throw std::invalid_argument("m = " + std::to_string(s.m) + " is no square number");
}

Eigen::ArrayXd Normalize(const Eigen::ArrayXd& values) {
    const double min = values.minCoeff(), max = values.maxCoeff();
    return (values - min) / (max - min + std::numeric_limits<double>::epsilon());
}

FeatureHistory::FeatureHistory(const ModelSettings& settings) : settings(settings) {
    CheckSettings(settings);
}

void FeatureHistory::Add(int spp, std::span<const double> feature) {
    if (feature.size() != size_t(settings.m))
        throw std::invalid_argument("a feature of m values is needed");
    if (!std::all_of(feature.begin(), feature.end(), [](double v) { return std::isfinite(v); }))
        throw std::invalid_argument("a feature is NaN or infinite");
    if (spp < 1 || (!entries.empty() && spp <= entries.back().spp))
        throw std::invalid_argument("features must come with increasing spp");

    // Forget what has left the window of this and all later spp.
    const int64_t oldest = int64_t(spp) - int64_t(settings.k - 1) * settings.n;
    std::erase_if(entries, [&](const Entry& e) { return e.spp < oldest; });
    entries.push_back({spp, {feature.begin(), feature.end()}});
}

const std::vector<double>* FeatureHistory::Find(int spp) const {
    const auto it = std::lower_bound(entries.begin(), entries.end(), spp,
                                     [](const Entry& e, int s) { return e.spp < s; });
    return it != entries.end() && it->spp == spp ? &it->feature : nullptr;
}

std::optional<Eigen::MatrixXf> FeatureHistory::WindowAt(int spp) const {
    Eigen::ArrayXXd window(settings.m, settings.k);
    for (int step = 0; step < settings.k; ++step) {
        const int64_t at = int64_t(spp) - int64_t(settings.k - 1 - step) * settings.n;
        const std::vector<double>* feature = at > 0 ? Find(int(at)) : nullptr;
        if (!feature) return {};
        window.col(step) = Eigen::Map<const Eigen::ArrayXd>(feature->data(), settings.m);
    }
    // Normalise in double: late in a rendering the values of a window differ by little.
    if (settings.bnorm)
        for (int step = 0; step < settings.k; ++step)
            window.col(step) = Normalize(window.col(step));
    if (settings.snorm)
        for (int i = 0; i < settings.m; ++i)
            window.row(i) = Normalize(window.row(i).transpose()).transpose();
    return window.matrix().cast<float>();
}

}  // namespace lull
