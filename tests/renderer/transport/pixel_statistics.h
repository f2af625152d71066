// Measures mean and variance of single samples, pixel by pixel, and reads those of pbrt-v3.
#pragma once

#include <algorithm>
#include <atomic>
#include <cstdlib>
#include <string>
#include <variant>
#include <vector>

#include "renderer/image/image_io.h"
#include "renderer/transport/integrator.h"
#include "stopping/base/parallel.h"

namespace lull {

inline constexpr Estimator kEstimators[] = {Estimator::Combined, Estimator::PbrtV3};

struct PixelStatistics {
    int width = 0, height = 0, samples = 0;
    std::vector<Eigen::Array3d> mean, variance;  // row-major; variance of one sample, unbiased
    int64_t rejected = 0;
};

// Takes `samples` of every pixel on all cores. The film's scale is divided out again.
inline PixelStatistics MeasurePixels(const Scene& scene, Estimator estimator, SamplerKind kind,
                                     int samples, uint64_t seed) {
    const Vec2i size = scene.film.Size();
    PixelStatistics result{size.x(), size.y(), samples, {}, {}, 0};
    result.mean.resize(size_t(size.x()) * size.y());
    result.variance.resize(result.mean.size());
    std::atomic<int64_t> rejected = 0;
    ForEachIndex(size.y(), [&](int y) {
        Sampler sampler(kind, seed);
        for (int x = 0; x < size.x(); ++x) {
            // Update mean and sum of squares one by one (Welford 1962): stable for tails.
            Eigen::Array3d mean = Eigen::Array3d::Zero(), sum2 = Eigen::Array3d::Zero();
            for (int k = 0; k < samples; ++k) {
                const PathSample sample =
                    RenderSample(scene, estimator, sampler, scene.film.cropMin + Vec2i(x, y), k);
                rejected += sample.rejected;
                const Eigen::Array3d v = sample.radiance.cast<double>() / scene.film.scale;
                const Eigen::Array3d delta = v - mean;
                mean += delta / (k + 1);
                sum2 += delta * (v - mean);
            }
            result.mean[size_t(y) * size.x() + x] = mean;
            result.variance[size_t(y) * size.x() + x] = sum2 / std::max(1, samples - 1);
        }
    });
    result.rejected = rejected;
    return result;
}

// Reads R, G, B, their variances and samplesPerPixel of an EXR.
inline PixelStatistics ReadStatistics(const std::string& path) {
    const ExrImage image = ReadExr(path);
    const ExrAttribute& samples = image.attributes.at("samplesPerPixel");
    PixelStatistics result{image.width, image.height, 0, {}, {}, 0};
    result.samples = std::holds_alternative<int>(samples) ? std::get<int>(samples)
                                                          : int(std::get<float>(samples));
    const size_t count = size_t(image.width) * image.height;
    result.mean.resize(count);
    result.variance.resize(count);
    const char* names[] = {"R", "G", "B"};
    for (int c = 0; c < 3; ++c)
        for (size_t i = 0; i < count; ++i) {
            result.mean[i][c] = image.Find(names[c])->values[i];
            result.variance[i][c] = image.Find(std::string("variance.") + names[c])->values[i];
        }
    return result;
}

// Reads a positive number from the environment, for longer runs than a test run affords.
inline int FromEnvironment(const char* name, int otherwise) {
    const char* value = std::getenv(name);
    return value ? std::max(2, std::atoi(value)) : otherwise;
}

// The mean over an image, with its standard error.
struct ImageMean {
    Eigen::Array3d mean = Eigen::Array3d::Zero(), error = Eigen::Array3d::Zero();
};

inline ImageMean MeanOf(const PixelStatistics& pixels) {
    ImageMean image;
    const double n = double(pixels.mean.size());
    for (const Eigen::Array3d& mean : pixels.mean) image.mean += mean / n;
    for (const Eigen::Array3d& variance : pixels.variance) image.error += variance;
    image.error = (image.error / pixels.samples).sqrt() / n;
    return image;
}

}  // namespace lull
