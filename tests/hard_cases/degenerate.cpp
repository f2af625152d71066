// Geometry that has no business to be there, but is.
#include <fmt/format.h>

#include <cmath>

#include "tests/hard_cases/known_scene.h"

namespace lull {

namespace {

constexpr const char* kHalf = "Material \"matte\" \"rgb Kd\" [.5 .5 .5]\n";
constexpr const char* kFromAbove = "0 0 -3  0 0 0  0 1 0";

// A floor cut in 2,000 slivers, each of them 1e5 times as long as wide, which fills the image.
HardCaseResult Slivers(const HardCaseOptions& options) {
    constexpr int kCount = 1000;
    constexpr double kWidth = 0.2, kHalfLength = 10;
    std::string points, indices;
    for (int i = 0; i <= kCount; ++i) {
        const double x = kWidth * (double(i) / kCount - 0.5);
        points += fmt::format("{0:.9g} {1} 0 {0:.9g} {2} 0 ", x, -kHalfLength, kHalfLength);
        if (i < kCount)
            indices +=
                fmt::format("{0} {1} {3} {0} {3} {2} ", 2 * i, 2 * i + 1, 2 * i + 2, 2 * i + 3);
    }
    const auto scene = MakeScene({.world = kSky + std::string(kHalf) + MeshText(indices, points),
                                  .camera = kFromAbove,
                                  .fov = 2});
    return CompareRadiance(*scene, 0.5, 1e-3, options.isLong ? 100'000 : 2000, options);
}

// The same floor three times, with points and lines for triangles in between.
HardCaseResult Duplicates(const HardCaseOptions& options) {
    const auto scene =
        MakeScene({.world = kSky + std::string(kHalf) + FloorText(5) + FloorText(5) + FloorText(5) +
                            MeshText("0 1 1  0 0 0  0 1 2  0 1 3", "-5 0 0  5 0 0  2 0 0  0 5 0"),
                   .camera = kFromAbove,
                   .fov = 20});
    return CompareRadiance(*scene, 0.5, 1e-3, options.isLong ? 100'000 : 2000, options);
}

// A lamp in the very plane of the floor shines on nothing of it: only the sky does.
HardCaseResult CoplanarLight(const HardCaseOptions& options) {
    const auto scene =
        MakeScene({.world = kSky + std::string(kHalf) + FloorText(5) +
                            "AttributeBegin AreaLightSource \"diffuse\" \"rgb L\" [1e6 1e6 1e6] "
                            "\"bool twosided\" \"true\"\n" +
                            MeshText("0 3 2 0 2 1", "2 2 0  3 2 0  3 3 0  2 3 0") + "AttributeEnd",
                   .camera = kFromAbove,
                   .fov = 20});
    return CompareRadiance(*scene, 0.5, 1e-3, options.isLong ? 100'000 : 2000, options);
}

// A camera in the floor that looks up sees the sky, whichever way it is turned.
HardCaseResult CameraOnSurface(const HardCaseOptions& options) {
    std::vector<HardCaseResult> results;
    for (const char* camera : {"0 0 0  0 0 -1  0 1 0", "1 1 0  0.5 0 -1  0 1 0"}) {
        const auto scene = MakeScene(
            {.world = kSky + std::string(kHalf) + FloorText(5), .camera = camera, .fov = 30});
        results.push_back(CompareRadiance(*scene, 1, 0, options.isLong ? 10'000 : 100, options));
    }
    return Worst(results);
}

// Radiance within glass is index^2 of that outside. From the centre all rays meet it upright.
HardCaseResult CameraInGlass(const HardCaseOptions& options) {
    const auto scene = MakeScene(
        {.world = kSky + std::string("Material \"glass\" \"float eta\" [1.5]\nShape \"sphere\""),
         .camera = "0 0 0  0.2 0.3 1  0 1 0",
         .fov = 60,
         .integrator = "\"integer maxdepth\" [100]"});
    return CompareRadiance(*scene, 2.25, 1e-5, options.isLong ? 10'000 : 200, options);
}

// A mesh of nothing but triangles without area, beside a floor.
HardCaseResult NothingButDegenerate(const HardCaseOptions& options) {
    const auto scene =
        MakeScene({.world = kSky + std::string(kHalf) + FloorText(5) +
                            "AreaLightSource \"diffuse\" \"rgb L\" [9 9 9]\n" +
                            MeshText("0 1 1  0 0 0  0 1 2", "-5 0 -1  5 0 -1  2 0 -1"),
                   .camera = kFromAbove,
                   .fov = 20});
    return CompareRadiance(*scene, 0.5, 1e-3, options.isLong ? 100'000 : 2000, options);
}

}  // namespace

std::vector<HardCase> DegenerateCases() {
    return {{"degenerate", "floor of slivers 1e5 times as long as wide",
             "normals and offsets of slivers are noise", Slivers},
            {"degenerate", "the same floor three times, points and lines as triangles",
             "surfaces at one place shade each other; NaN normals", Duplicates},
            {"degenerate", "lamp of 1e6 in the plane of the floor", "0/0 where the cosine is zero",
             CoplanarLight},
            {"degenerate", "lamp all of whose triangles have no area",
             "infinite densities; a light that cannot be sampled", NothingButDegenerate},
            {"degenerate", "camera exactly on a surface",
             "the first ray hits the surface it starts on", CameraOnSurface},
            {"degenerate", "camera in the centre of a glass ball",
             "which side is inside is guessed from the camera", CameraInGlass}};
}

}  // namespace lull
