// Energy that must neither be lost nor made, glass, and surfaces that are all but smooth or looked
// at from all but their own plane.
#include <fmt/format.h>

#include <cmath>

#include "tests/hard_cases/known_scene.h"

namespace lull {

namespace {

// Returns the inside of a sphere that reflects a share `albedo` and emits 1 everywhere. With depth
// d all radiance in it is 1 + albedo + ... + albedo^d. Both ways to sample the light choose
// points with the same density, so that there is no noise but from roulette.
KnownScene Furnace(double albedo, int depth, const std::string& more = "") {
    return {.world = fmt::format("Material \"matte\" \"rgb Kd\" [{0} {0} {0}]\n"
                                 "AreaLightSource \"diffuse\" \"rgb L\" [1 1 1]\n"
                                 "ReverseOrientation\nShape \"sphere\" \"float radius\" [2]",
                                 albedo),
            .camera = "0.3 0.2 -1  0 0 0  0 1 0",
            .fov = 90,
            .integrator = fmt::format("\"integer maxdepth\" [{}] {}", depth, more)};
}

HardCaseResult WhiteFurnace(const HardCaseOptions& options) {
    const auto scene = MakeScene(Furnace(1, 1000, "\"float rrthreshold\" [0]"));
    return CompareRadiance(*scene, 1001, 1e-4, options.isLong ? 200 : 8, options,
                           "relative 1e-4, no roulette");
}

HardCaseResult NearlyWhiteFurnace(const HardCaseOptions& options) {
    const auto scene = MakeScene(Furnace(0.99, 1000));
    const double answer = (1 - std::pow(0.99, 1001)) / (1 - 0.99);
    return CompareRadiance(*scene, answer, 1e-4, options.isLong ? 10000 : 500, options);
}

// Two mirrors face each other; rays climb between them, 500 times to and fro, into the sky.
HardCaseResult MirrorHall(const HardCaseOptions& options) {
    const auto scene =
        MakeScene({.world = std::string(kSky) + "Material \"mirror\" \"rgb Kr\" [1 1 1]\n" +
                            MeshText("0 1 2 0 2 3  4 6 5 4 7 6",
                                     "-1 -1 -300  -1 1 -300  -1 1 300  -1 -1 300 "
                                     "1 -1 -300  1 1 -300  1 1 300  1 -1 300"),
                   .camera = "0 0 -290  1 0 -289  0 1 0",
                   .fov = 0.05,
                   .integrator = "\"integer maxdepth\" [1000] \"float rrthreshold\" [0]"});
    return CompareRadiance(*scene, 1, 1e-4, options.isLong ? 1000 : 50, options);
}

std::string Glass(double index, double roughness = 0) {
    return fmt::format(
        "Material \"glass\" \"float eta\" [{0}] \"rgb Kr\" [1 1 1] \"rgb Kt\" "
        "[1 1 1] \"float uroughness\" [{1}] \"float vroughness\" [{1}] "
        "\"bool remaproughness\" \"false\"\n",
        index, roughness);
}

constexpr const char* kDepth = "\"integer maxdepth\" [10000]";

HardCaseResult IndexOne(const HardCaseOptions& options) {
    const auto scene =
        MakeScene({.world = kSky + Glass(1) + "Shape \"sphere\" \"float radius\" [2]",
                   .camera = "0 0 -2.5  0 0 0  0 1 0",
                   .integrator = kDepth});
    return CompareRadiance(*scene, 1, 1e-6, options.isLong ? 10'000 : 200, options);
}

HardCaseResult NearIndexOne(const HardCaseOptions& options) {
    std::vector<HardCaseResult> results;
    for (const double index : {0.999999, 1.0000001, 1.000001, 1.0001}) {
        const auto scene =
            MakeScene({.world = kSky + Glass(index) + "Shape \"sphere\" \"float radius\" [2]",
                       .camera = "0 0 -2.5  0 0 0  0 1 0",
                       .integrator = kDepth});
        results.push_back(CompareRadiance(*scene, 1, 1e-4, options.isLong ? 10'000 : 200, options,
                                          fmt::format("worst: index {:.9g}", index)));
    }
    return Worst(results);
}

// A rod 200 times as long as wide carries light to its other end by total internal reflection.
HardCaseResult LightGuide(const HardCaseOptions& options) {
    const auto scene = MakeScene({.world = kSky + Glass(1.5) + BoxText({-1, -1, 0}, {1, 1, 400}),
                                  .camera = "0 0 -1  0.3 0.2 0  0 1 0",
                                  .fov = 30,
                                  .integrator = kDepth});
    return CompareRadiance(*scene, 1, 1e-4, options.isLong ? 10'000 : 300, options);
}

HardCaseResult NestedGlass(const HardCaseOptions& options) {
    std::string world = kSky;
    for (const double index : {1.5, 1.33, 2.4, 1.1})
        world += Glass(index) + fmt::format("Shape \"sphere\" \"float radius\" [{}]\n", index);
    // One that overlaps all of them, and one that touches another from within.
    world += Glass(1.7) + "AttributeBegin Translate 1 0.5 0 Shape \"sphere\" AttributeEnd\n" +
             "AttributeBegin Translate 0 0 1.4 Shape \"sphere\" AttributeEnd\n";
    const auto scene =
        MakeScene({.world = world, .camera = "0 0 -4  0 0 0  0 1 0", .integrator = kDepth});
    return CompareRadiance(*scene, 1, 1e-4, options.isLong ? 10'000 : 1000, options);
}

// Two boxes of glass with a gap between them that is near what coordinates can be wrong by. (Faces
// that are at the very same place count as one, as in pbrt-v3.)
HardCaseResult AlmostTouching(const HardCaseOptions& options) {
    const auto scene = MakeScene({.world = kSky + Glass(1.5) + BoxText({-1, -1, 0}, {1, 1, 1}) +
                                           Glass(1.33) + BoxText({-1, -1, 1.00001}, {1, 1, 2}),
                                  .camera = "0 0.4 -3  0 0 0  0 1 0",
                                  .fov = 30,
                                  .integrator = kDepth});
    return CompareRadiance(*scene, 1, 1e-4, options.isLong ? 10'000 : 1000, options);
}

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

std::vector<HardCase> MaterialCases() {
    return {
        {"energy", "white furnace, albedo 1, depth 1,000",
         "energy leaks a little at each bounce; depth is counted wrongly", WhiteFurnace},
        {"energy", "furnace of albedo 0.99, depth 1,000",
         "long paths are cut off for good or weighed twice", NearlyWhiteFurnace},
        {"energy", "hall of mirrors, about 300 reflections",
         "origins drift off the mirrors, or into them", MirrorHall},
        {"dielectrics", "ball with index of refraction 1",
         "0/0 in Fresnel's formulas; a rim of total reflection", IndexOne},
        {"dielectrics", "balls with indices of 1 +- 1e-7 to 1e-4",
         "cancellation about the critical angle", NearIndexOne},
        {"dielectrics", "light guide, 200 times as long as wide",
         "chains of total internal reflection lose rays in edges", LightGuide},
        {"dielectrics", "six balls of glass within and across each other",
         "radiance scaled by index^2 once too often", NestedGlass},
        {"dielectrics", "two boxes of glass, 1e-5 apart", "offsets that carry rays through the gap",
         AlmostTouching},
        {"roughness", "metal that reflects everything, roughness 1e-4 to 1e-2",
         "overflow of the distribution of normals in float", NearlySmoothMetal},
        {"roughness", "glass of roughness 1e-4", "NaN half vectors; densities near 1e8",
         NearlySmoothGlass},
        {"roughness", "white planes seen at an angle of 1e-6", "division by the cosine", Grazing},
        {"roughness", "point light at an angle of 1e-6 to the plane",
         "the light is taken to be in the plane", GrazingLight}};
}

}  // namespace lull
