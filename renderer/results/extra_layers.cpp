#include "renderer/results/extra_layers.h"

#include <algorithm>
#include <iterator>
#include <nlohmann/json.hpp>
#include <set>

#include "renderer/results/cryptomatte.h"
#include "renderer/scene/scene_names.h"

namespace lull {

namespace {

template <typename Name>
std::string NamesOf(const AovFilm& aovs, uint32_t AovPixel::*number, const Name& name) {
    std::set<uint32_t> numbers;
    for (const AovPixel& pixel : aovs.Pixels()) numbers.insert(pixel.*number);
    numbers.erase(0);
    nlohmann::ordered_json names = nlohmann::ordered_json::object();
    for (const uint32_t n : numbers) names[std::to_string(n)] = name(n);
    return names.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
}

}  // namespace

void RemoveBackground(double covered, double mean, double background, bool isDenoised,
                      float* colour) {
    if (covered == 0)
        *colour = 0;
    else if (isDenoised)
        *colour *= mean > 0 ? float(std::clamp((mean - background) / mean, 0.0, 1.0)) : 0;
    else
        *colour -= float(background);
}

ExtraLayers MakeExtraLayers(const CollectedLayers& layers, const Film& film,
                            const Description& description, const Scene& scene) {
    const AovSet& wanted = layers.wanted;
    const auto objectName = [&](uint32_t n) { return NameOfObject(n, description, scene); };
    const auto materialName = [&](uint32_t n) { return NameOfMaterial(n, description); };
    ExtraLayers extra;
    if (wanted.Any()) extra.attributes["aov"] = TextOf(wanted);
    if (layers.aovs) {
        extra.channels = MakeAovChannels(*layers.aovs, film);
        if (wanted.object)
            extra.attributes["objectNames"] = NamesOf(*layers.aovs, &AovPixel::object, objectName);
        if (wanted.material)
            extra.attributes["materialNames"] =
                NamesOf(*layers.aovs, &AovPixel::material, materialName);
    }
    if (wanted.alpha) {
        ExrChannel alpha{.name = "A", .values = {}};
        for (const AlphaPixel& pixel : layers.mattes->alpha.Pixels())
            alpha.values.push_back(pixel.Alpha());
        extra.channels.push_back(std::move(alpha));
    }
    if (wanted.cryptomatte) {
        const auto add = [&](ExtraLayers more) {
            std::ranges::move(more.channels, std::back_inserter(extra.channels));
            extra.attributes.merge(more.attributes);
        };
        add(MakeCryptomatte("CryptoObject", *layers.mattes, &CryptoPixel::objects, objectName));
        add(MakeCryptomatte("CryptoMaterial", *layers.mattes, &CryptoPixel::materials,
                            materialName));
    }
    return extra;
}

}  // namespace lull
