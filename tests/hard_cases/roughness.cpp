// Surfaces that are all but smooth, and looked at from all but their own plane.
#include <fmt/format.h>

#include "tests/hard_cases/known_scene.h"

namespace lull {

namespace {

// Metal with index 0 and absorption 1 reflects everything at every angle.
std::string WhiteMetal(double roughness) {
    return fmt::format(
        "Material \"metal\" \"rgb eta\" [0 0 0] \"rgb k\" [1 1 1] \"float "
        "roughness\" [{}] \"bool remaproughness\" \"false\"\n",
        roughness);
}

HardCaseResult NearlySmoothMetal(const HardCaseOptions& options) {
    std::vector<HardCaseResult> results;
    for (const double roughness : {1e-4, 1e-3, 1e-2}) {
        const auto scene = MakeScene(
            {.world = kSky + WhiteMetal(roughness) + "Shape \"sphere\" \"float radius\" [2]",
             .camera = "0 0 -2.5  0 0 0  0 1 0"});
        results.push_back(CompareRadiance(*scene, 1, 2e-3, options.isLong ? 10'000 : 500, options,
                                          fmt::format("worst: roughness {:g}", roughness)));
    }
    return Worst(results);
}

HardCaseResult NearlySmoothGlass(const HardCaseOptions& options) {
    const auto scene =
        MakeScene({.world = kSky +
                            std::string("Material \"glass\" \"float uroughness\" [1e-4] \"float "
                                        "vroughness\" [1e-4] \"bool remaproughness\" \"false\"\n") +
                            "Shape \"sphere\" \"float radius\" [2]",
                   .camera = "0 0 -2.5  0 0 0  0 1 0",
                   .integrator = "\"integer maxdepth\" [100]"});
    return CompareRadiance(*scene, 1, 2e-3, options.isLong ? 10'000 : 1000, options);
}

// Looks along a plane, 1e-6 above it for each unit of length.
HardCaseResult Grazing(const HardCaseOptions& options) {
    std::vector<HardCaseResult> results;
    const struct {
        const char* name;
        std::string material;
    } kinds[] = {{"matte", "Material \"matte\" \"rgb Kd\" [1 1 1]\n"},
                 {"mirror", "Material \"mirror\" \"rgb Kr\" [1 1 1]\n"},
                 {"smooth metal", WhiteMetal(1e-4)}};
    for (const auto& kind : kinds) {
        const auto scene = MakeScene({.world = kSky + kind.material + FloorText(1e5),
                                      .camera = "0 0 -0.001  1000 0 0  0 0 -1",
                                      .fov = 1e-5,
                                      .integrator = "\"integer maxdepth\" [100]"});
        results.push_back(CompareRadiance(*scene, 1, 2e-3, options.isLong ? 10'000 : 500, options,
                                          std::string("worst: ") + kind.name));
    }
    return Worst(results);
}

// Light that arrives at 1e-6 from a matte plane: irradiance is I cos / d^2.
HardCaseResult GrazingLight(const HardCaseOptions& options) {
    const double cosine = 1e-6, intensity = 1e6;
    const auto scene = MakeScene(
        {.world = fmt::format("LightSource \"point\" \"rgb I\" [{0} {0} {0}] \"point from\" "
                              "[1 0 {1}]\nMaterial \"matte\" \"rgb Kd\" [1 1 1]\n",
                              intensity, -cosine) +
                  FloorText(5),
         .camera = "0 0 -1  0 0 0  0 1 0",
         .fov = 1e-4,
         .size = 1});
    return CompareRadiance(*scene, intensity * cosine / std::numbers::pi, 1e-4, 16, options);
}

}  // namespace

std::vector<HardCase> RoughnessCases() {
    return {
        {"roughness", "metal that reflects everything, roughness 1e-4 to 1e-2",
         "overflow of the distribution of normals in float", NearlySmoothMetal},
        {"roughness", "glass of roughness 1e-4", "NaN half vectors; densities near 1e8",
         NearlySmoothGlass},
        {"roughness", "white planes seen at an angle of 1e-6", "division by the cosine", Grazing},
        {"roughness", "point light at an angle of 1e-6 to the plane",
         "the light is taken to be in the plane", GrazingLight}};
}

}  // namespace lull
