// Renders by bidirectional path tracing, or by paths, and measures the means of blocks of pixels
// and their standard errors, from independent pictures of different seeds.
#pragma once

#include <vector>

#include "renderer/transport/bdpt.h"
#include "stopping/base/parallel.h"

namespace lull {

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

}  // namespace lull
