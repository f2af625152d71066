// Compares the means of blocks by bidirectional path tracing and by paths from the camera.
#pragma once

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <vector>

#include "renderer/transport/bdpt.h"
#include "stopping/base/parallel.h"
#include "tests/renderer/scene_of.h"

namespace lull {

// Renders by bidirectional path tracing, or by paths, and measures the means of blocks of pixels
// and their standard errors, from independent pictures of different seeds.

struct BlockMeans {
    int columns = 0, rows = 0;
    std::vector<Eigen::Array3d> mean, error;                            // row-major
    Eigen::Array3d total = Eigen::Array3d::Zero(), totalError = total;  // of the whole image
};

// Renders a picture with `spp` samples a pixel; returns it row-major.
inline std::vector<Eigen::Array3d> Picture(const Scene& scene, const BdptShares& shares, int spp,
                                           uint64_t seed) {
    const Vec2i size = scene.film.resolution;
    std::vector<Eigen::Array3d> image(size_t(size.x()) * size_t(size.y()), Eigen::Array3d::Zero());
    Sampler sampler(SamplerKind::Sobol, seed);
    PathOptions options = Estimator::Combined;
    options.shares = shares;
    for (int y = 0; y < size.y(); ++y)
        for (int x = 0; x < size.x(); ++x)
            for (int k = 0; k < spp; ++k)
                image[size_t(y) * size_t(size.x()) + size_t(x)] +=
                    RenderSample(scene, options, sampler, {x, y}, uint32_t(k))
                        .radiance.cast<double>();
    const Vec2f radius = scene.filter.Radius();
    const auto splat = [&](const Splat& s) {
        for (int y = 0; y < size.y(); ++y) {
            if (std::abs(s.film.y() - float(y) - 0.5f) > radius.y()) continue;
            for (int x = 0; x < size.x(); ++x) {
                const Vec2f offset = s.film - Vec2f(float(x) + 0.5f, float(y) + 0.5f);
                image[size_t(y) * size_t(size.x()) + size_t(x)] +=
                    (s.radiance * scene.filter.Evaluate(offset)).cast<double>();
            }
        }
    };
    const auto paths =
        TracesFromLights(scene.integrator) ? uint32_t(LightPathCount(scene, shares)) : 0;
    std::vector<Splat> splats;
    for (int k = 0; k < spp; ++k)
        for (uint32_t i = 0; i < paths; ++i) {
            TraceLightPath(scene, shares, sampler, uint32_t(k), i, &splats);
            for (const Splat& s : splats) splat(s);
        }
    for (Eigen::Array3d& pixel : image) pixel /= double(spp) * double(scene.film.scale);
    return image;
}

// Sanitizers slow renders down by ten: errors are then larger, and the tests as strict.
#ifdef __SANITIZE_ADDRESS__
inline constexpr int kFewer = 16;
#else
inline constexpr int kFewer = 1;
#endif

// Takes `pictures` pictures of `spp` samples on all cores. Blocks have `side` pixels.
inline BlockMeans MeasureBlocks(const Scene& scene, const BdptShares& shares, int spp, int pictures,
                                int side, uint64_t seed = 1) {
    spp = std::max(1, spp / kFewer);
    const Vec2i size = scene.film.resolution;
    BlockMeans means{size.x() / side, size.y() / side, {}, {}};
    const size_t count = size_t(means.columns) * size_t(means.rows);
    const auto n = size_t(pictures);
    std::vector<std::vector<Eigen::Array3d>> blocks(n, std::vector<Eigen::Array3d>(count));
    std::vector<Eigen::Array3d> totals(n, Eigen::Array3d::Zero());
    ForEachIndex(pictures, [&](int i) {
        const auto image = Picture(scene, shares, spp, seed * 1000 + uint64_t(i));
        for (size_t b = 0; b < count; ++b) {
            Eigen::Array3d sum = Eigen::Array3d::Zero();
            const int left = int(b) % means.columns * side, top = int(b) / means.columns * side;
            for (int y = top; y < top + side; ++y)
                for (int x = left; x < left + side; ++x)
                    sum += image[size_t(y) * size_t(size.x()) + size_t(x)];
            blocks[size_t(i)][b] = sum / Sqr(double(side));
            totals[size_t(i)] += blocks[size_t(i)][b] / double(count);
        }
    });
    const auto measure = [&](const auto& of, Eigen::Array3d* mean, Eigen::Array3d* error) {
        *mean = *error = Eigen::Array3d::Zero();
        for (int i = 0; i < pictures; ++i) *mean += of(size_t(i)) / pictures;
        for (int i = 0; i < pictures; ++i) *error += (of(size_t(i)) - *mean).square();
        *error = (*error / (double(pictures) * (pictures - 1))).sqrt();
    };
    means.mean.resize(count);
    means.error.resize(count);
    for (size_t b = 0; b < count; ++b)
        measure([&](size_t i) { return blocks[i][b]; }, &means.mean[b], &means.error[b]);
    measure([&](size_t i) { return totals[i]; }, &means.total, &means.totalError);
    return means;
}

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
