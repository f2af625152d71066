// Makes blocks to judge.
#pragma once

#include <cmath>
#include <random>
#include <vector>

#include "stopping/rules/rule.h"

namespace lull {

// Contents of a BlockView.
struct BlockImage {
    int width, height;
    std::vector<float> mean, halfMean;

    BlockImage(int width, int height, float value)
        : width(width), height(height), mean(size_t(3 * width * height), value), halfMean(mean) {}

    float* Mean(int x, int y) { return &mean[size_t(3 * (y * width + x))]; }
    float* HalfMean(int x, int y) { return &halfMean[size_t(3 * (y * width + x))]; }
    BlockView At(int spp) const { return {width, height, spp, mean, halfMean}; }
};

// Returns a smooth image with independent Gaussian noise, which `spp` samples of deviation `noise`
// leave in both means.
inline BlockImage NoisyBlock(int width, int height, double noise, int spp, unsigned seed) {
    std::mt19937 generator(seed);
    std::normal_distribution<double> gauss(0, noise / std::sqrt(spp / 2.0));
    BlockImage image(width, height, 0);
    for (size_t i = 0; i < image.mean.size(); ++i) {
        const double truth = 0.2 + 0.3 * double(i) / double(image.mean.size());
        const double a = truth + gauss(generator), b = truth + gauss(generator);
        image.halfMean[i] = float(a);
        image.mean[i] = float((a + b) / 2);
    }
    return image;
}

}  // namespace lull
