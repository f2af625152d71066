#include "renderer/film/layer.h"

#include <fmt/format.h>

#include <algorithm>

#include "renderer/base/error.h"

namespace lull {

namespace {

struct NamedLayer {
    const char* name;
    bool AovSet::*wanted;
};
constexpr NamedLayer kLayers[] = {{"albedo", &AovSet::albedo},
                                  {"normal", &AovSet::normal},
                                  {"depth", &AovSet::depth},
                                  {"position", &AovSet::position},
                                  {"object", &AovSet::object},
                                  {"material", &AovSet::material},
                                  {"noise", &AovSet::noise},
                                  {"alpha", &AovSet::alpha},
                                  {"cryptomatte", &AovSet::cryptomatte}};

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

std::string AllAovs(const char* separator) {
    std::string names;
    for (const NamedLayer& layer : kLayers)
        names.append(names.empty() ? "" : separator).append(layer.name);
    return names;
}

AovSet ParseAovs(const std::vector<std::string>& names) {
    AovSet set;
    for (const std::string& name : names) {
        const auto layer = std::ranges::find(kLayers, name, &NamedLayer::name);
        if (layer == std::end(kLayers))
            throw Error(fmt::format("there is no layer \"{}\", but {}, with commas between them",
                                    name, AllAovs(", ")));
        set.*layer->wanted = true;
    }
    return set;
}

}  // namespace lull
