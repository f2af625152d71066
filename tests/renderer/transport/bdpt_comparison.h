// Compares the means of blocks by bidirectional path tracing and by paths from the camera.
#pragma once

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "tests/renderer/scene_of.h"
#include "tests/renderer/transport/bdpt_image.h"

namespace lull {

inline constexpr int kSide = 8;  // pixels of a block

// How each picture is taken: with all strategies, without those that see light paths, or with few
// samples of those that start from lights.
inline constexpr BdptShares kAll{1, 1}, kFromCamera{0, 1}, kFew{0.25f, 0.3f}, kOnlyLightPaths{1, 0};

struct Scenes {
    std::unique_ptr<const Scene> path, bdpt;
};

inline Scenes Both(const std::string& file, int size, int maxDepth) {
    Scenes scenes;
    for (const bool isBdpt : {false, true}) {
        Warnings warnings;
        Description description = ParsePbrt(file, warnings);
        description.integrator.name = isBdpt ? "bdpt" : "path";
        CompileOptions options;
        options.film.resolution = Vec2i(size, size);
        options.maxDepth = maxDepth;
        options.threads = 1;
        (isBdpt ? scenes.bdpt : scenes.path) = Compile(description, options, warnings);
    }
    return scenes;
}

inline Scenes BothOf(const std::string& world, int size, int maxDepth,
                     const std::string& camera =
                         "LookAt 0 0 -3  0 0 0  0 1 0\n"
                         "Camera \"perspective\" \"float fov\" [60]\n") {
    const TemporaryDirectory folder;
    return Both(folder.Write("test.pbrt", WorldText(world, camera + "PixelFilter \"box\"\n")), size,
                maxDepth);
}

// Expects no more blocks beyond 3 standard errors than chance has, and the total within 4.
inline void ExpectSame(const BlockMeans& a, const BlockMeans& b, const std::string& what) {
    int out = 0;
    for (size_t i = 0; i < a.mean.size(); ++i) {
        const double d = a.mean[i].sum() - b.mean[i].sum();
        const double e = std::hypot(a.error[i].sum(), b.error[i].sum());
        const double z = e > 0 ? d / e : 0;
        out += std::abs(z) > 3;
    }
    const double d = a.total.sum() - b.total.sum();
    const double e = std::hypot(a.totalError.sum(), b.totalError.sum());
    const double n = double(a.mean.size());
    EXPECT_LT(std::abs(d), 4 * e + 1e-7) << what << ": " << a.total.mean() << " " << b.total.mean();
    EXPECT_LE(out, 2 + 0.03 * n) << what;
}

inline void Compare(const Scenes& scenes, int spp, int pictures, const std::string& name,
                    std::span<const BdptShares> all) {
    const BlockMeans paths = MeasureBlocks(*scenes.path, {}, spp, pictures, kSide, 7);
    for (const BdptShares& shares : all)
        ExpectSame(MeasureBlocks(*scenes.bdpt, shares, spp, pictures, kSide, 8), paths,
                   fmt::format("{}, {} light paths, {} connections", name, shares.lightPaths,
                               shares.connections));
}

inline constexpr BdptShares kWays[] = {kFromCamera, kAll, kFew, kOnlyLightPaths};

}  // namespace lull
