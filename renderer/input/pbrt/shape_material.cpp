#include "renderer/input/pbrt/shape_material.h"

#include <algorithm>
#include <string_view>

namespace lull {
namespace {

// Those of pbrt-v3's materials; no shape has one of these names.
constexpr std::string_view kParameters[] = {"Kd",
                                            "Ks",
                                            "Kr",
                                            "Kt",
                                            "amount",
                                            "anisotropic",
                                            "beta_m",
                                            "beta_n",
                                            "bsdffile",
                                            "bumpmap",
                                            "clearcoat",
                                            "clearcoatgloss",
                                            "color",
                                            "difftrans",
                                            "eta",
                                            "eumelanin",
                                            "flatness",
                                            "index",
                                            "k",
                                            "metallic",
                                            "mfp",
                                            "opacity",
                                            "pheomelanin",
                                            "reflect",
                                            "remaproughness",
                                            "roughness",
                                            "scatterdistance",
                                            "sheen",
                                            "sheentint",
                                            "sigma",
                                            "sigma_a",
                                            "sigma_s",
                                            "spectrans",
                                            "speculartint",
                                            "thin",
                                            "transmit",
                                            "uroughness",
                                            "vroughness"};

bool IsOfMaterial(const Parameter& parameter) {
    return std::ranges::find(kParameters, parameter.name) != std::end(kParameters);
}

}  // namespace

std::optional<MaterialEntity> MaterialOfShape(const MaterialEntity& material,
                                              const ShapeEntity& shape) {
    const std::vector<Parameter>& own = shape.parameters.All();
    if (std::ranges::none_of(own, IsOfMaterial)) return {};
    MaterialEntity result = material;
    result.parameters = {};
    for (const Parameter& parameter : material.parameters.All())
        if (std::ranges::find(own, parameter.name, &Parameter::name) == own.end())
            result.parameters.Add(parameter);
    for (const Parameter& parameter : own) {
        if (!IsOfMaterial(parameter)) continue;
        result.parameters.Add(parameter);
        parameter.lookedUp = true;  // not unused as one of the shape
    }
    return result;
}

}  // namespace lull
