#include "stopping/features/model_settings.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "stopping/base/block_view.h"

namespace lull {

namespace {

constexpr std::array<std::pair<Feature, const char*>, 6> kFeatureNames = {
    {{Feature::H, "H"},
     {Feature::H1, "H1"},
     {Feature::H2, "H2"},
     {Feature::DetailMaskedNoise, "detail_masked_noise"},
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

std::string FeatureName(Feature feature) { return kFeatureNames[size_t(feature)].second; }

Pool ParsePool(const std::string& name) {
    if (name == "mean") return {1};
    if (name == "rms") return {2};
    if (name.size() == 2 && name[0] == 'p' && name[1] >= '3' && name[1] <= '9')
        return {name[1] - '0'};
    throw std::invalid_argument("pooling '" + name +
                                "' is not known; there are mean, rms and p3 to p9");
}

std::string PoolName(const Pool& pool) {
    return pool.exponent == 1   ? "mean"
           : pool.exponent == 2 ? "rms"
                                : "p" + std::to_string(pool.exponent);
}

template <typename T>
std::vector<T> ParseList(const std::string& names, T (*parse)(const std::string&)) {
    std::vector<T> list;
    for (size_t begin = 0; begin <= names.size();) {
        const size_t end = std::min(names.find(',', begin), names.size());
        const std::string name = names.substr(begin, end - begin);
        const T item = parse(name);
        if (std::find(list.begin(), list.end(), item) != list.end())
            throw std::invalid_argument("'" + name + "' comes twice in '" + names + "'");
        list.push_back(item);
        begin = end + 1;
    }
    return list;
}

template <typename T, typename Name>
std::string JoinNames(std::span<const T> list, Name name) {
    std::string names;
    for (const T& item : list) names.append(names.empty() ? "" : ",").append(name(item));
    return names;
}

}  // namespace

std::string FeatureNames(std::span<const Feature> features) {
    return JoinNames(features, FeatureName);
}

std::vector<Feature> ParseFeatures(const std::string& names) {
    return ParseList(names, ParseFeature);
}

std::string PoolNames(std::span<const Pool> pools) { return JoinNames(pools, PoolName); }

std::vector<Pool> ParsePools(const std::string& names) {
    return names.empty() ? std::vector<Pool>() : ParseList(names, ParsePool);
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
    auto check = [](const char* name, int value, int least, int most) {
        if (value < least || value > most)
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
    auto checkReal = [](const char* name, double value, double least, double most) {
        if (!(value >= least && value <= most))
            throw std::invalid_argument(std::string(name) + " = " + std::to_string(value) +
                                        " is not in [" + std::to_string(least) + ", " +
                                        std::to_string(most) + "]");
    };
    if (s.spacing == Spacing::Geometric) {
        checkReal("ratio", s.ratio, 1.1, 16);
        checkReal("ratio ^ (k - 1)", std::pow(s.ratio, s.k - 1), 1, 1e6);
    }
    checkReal("mask", s.visibility.mask, 1e-3, 1e9);
    checkReal("flare", s.visibility.flare, 0, 1);
    checkReal("nearness", s.visibility.nearness, 0, 10);
    checkReal("peak_limit", s.peakLimit, 0, 100);
    check("reference", s.visibility.reference, 1, 1 << 30);
    checkReal("caution", s.caution, 1e-3, 1e3);
    if (Needs(s, Feature::VisibleDrop) && s.m != 100)
        throw std::invalid_argument("visible_drop needs m = 100");
    if (s.features.empty()) throw std::invalid_argument("a model needs at least one feature");
}

}  // namespace lull
