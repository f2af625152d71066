#include "stopping/features/model_settings.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "stopping/base/block_view.h"

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
