// Energy that must neither be lost nor made, however often light is scattered.
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

}  // namespace

std::vector<HardCase> EnergyCases() {
    return {{"energy", "white furnace, albedo 1, depth 1,000",
             "energy leaks a little at each bounce; depth is counted wrongly", WhiteFurnace},
            {"energy", "furnace of albedo 0.99, depth 1,000",
             "long paths are cut off for good or weighed twice", NearlyWhiteFurnace},
            {"energy", "hall of mirrors, about 300 reflections",
             "origins drift off the mirrors, or into them", MirrorHall}};
}

}  // namespace lull
