#include "renderer/film/aov_set.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "renderer/base/error.h"

namespace lull {

namespace {

struct NamedLayer {
    const char* name;
    bool AovSet::*wanted;
};
constexpr std::array<NamedLayer, 9> kLayers = {{{"albedo", &AovSet::albedo},
                                                {"normal", &AovSet::normal},
                                                {"depth", &AovSet::depth},
                                                {"position", &AovSet::position},
                                                {"object", &AovSet::object},
                                                {"material", &AovSet::material},
                                                {"noise", &AovSet::noise},
                                                {"alpha", &AovSet::alpha},
                                                {"cryptomatte", &AovSet::cryptomatte}}};

}  // namespace

std::string NameOf(const AovSet& set) {
    std::string names;
    for (const NamedLayer& layer : kLayers) {
        if (!(set.*layer.wanted)) continue;
        if (!names.empty()) names += ',';
        names += layer.name;
    }
    return names;
}

std::string TextOf(const AovSet& set) {
    return NameOf(set) + (set.throughSpecular ? " through specular" : "");
}

AovSet ParseAovs(const std::vector<std::string>& names) {
    AovSet set;
    for (const std::string& name : names) {
        const auto layer = std::ranges::find(kLayers, name, &NamedLayer::name);
        if (layer == kLayers.end())
            throw Error(
                fmt::format("there is no layer \"{}\", but albedo, normal, depth, position, "
                            "object, material, noise, alpha and cryptomatte, with commas between "
                            "them",
                            name));
        set.*layer->wanted = true;
    }
    return set;
}

}  // namespace lull
