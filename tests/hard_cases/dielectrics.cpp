// Glass that reflects nothing, everything, or sits in other glass. All of it is lossless, and in an
// even sky cannot be seen.
#include <fmt/format.h>

#include "tests/hard_cases/known_scene.h"

namespace lull {

namespace {

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

}  // namespace

std::vector<HardCase> DielectricCases() {
    return {{"dielectrics", "ball with index of refraction 1",
             "0/0 in Fresnel's formulas; a rim of total reflection", IndexOne},
            {"dielectrics", "balls with indices of 1 +- 1e-7 to 1e-4",
             "cancellation about the critical angle", NearIndexOne},
            {"dielectrics", "light guide, 200 times as long as wide",
             "chains of total internal reflection lose rays in edges", LightGuide},
            {"dielectrics", "six balls of glass within and across each other",
             "radiance scaled by index^2 once too often", NestedGlass},
            {"dielectrics", "two boxes of glass, 1e-5 apart",
             "offsets that carry rays through the gap", AlmostTouching}};
}

}  // namespace lull
