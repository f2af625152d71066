// Makes pictures whose truth is known, and noise for them.
#pragma once

#include <cmath>
#include <functional>
#include <random>

#include "renderer/denoise/denoise.h"

namespace lull {

// Returns an image of `value(c, x, y)`.
inline Planes MakePlanes(int width, int height, int count,
                         const std::function<double(int c, int x, int y)>& value) {
    Planes planes(width, height, count);
    for (int c = 0; c < count; ++c)
        for (int y = 0; y < height; ++y)
            for (int x = 0; x < width; ++x) planes.Row(c, y)[x] = float(value(c, x, y));
    return planes;
}

// Returns a grey wall that faces the camera, as features see it.
inline Planes FlatFeatures(int width, int height) {
    return MakePlanes(width, height, kFeatures, [](int c, int, int) {
        return c < 3 ? 0.5 : c == 5 ? 1.0 : c == 6 ? 3.0 : 0.0;
    });
}

// Returns both halves of the features as the denoiser takes them.
inline Planes Filtered(const Halves& features) {
    const Planes& a = features.a;
    return FilterFeatures(a.width, a.height, [&](int y0, int y1) {
        const ImageTile rows{0, y0, a.width, y1};
        return Halves{Crop(a, rows), Crop(features.b, rows)};
    });
}

// Returns `truth` with Gaussian noise of this deviation in each half.
inline Halves NoisyHalves(const Planes& truth, double deviation, unsigned seed) {
    std::mt19937 generator(seed);
    std::normal_distribution<double> gauss;  // its own deviation has to be above 0
    Halves noisy{truth, truth};
    for (Planes* half : {&noisy.a, &noisy.b})
        for (float& v : half->values) v = std::max(0.f, v + float(deviation * gauss(generator)));
    return noisy;
}

// Returns the same with features, which it filters: that takes much longer than the noise.
inline NoisyPicture AddNoise(const Planes& truth, const Planes& features, double deviation,
                             unsigned seed) {
    return {NoisyHalves(truth, deviation, seed), Filtered({features, features}), {}, {}};
}

// Returns a grey picture of 110 x 50 pixels whose left half has no noise; there is much right of
// x = 60.
inline NoisyPicture NoiseOnTheRight() {
    const Planes truth(110, 50, 3, 0.3f);
    NoisyPicture noisy = AddNoise(truth, FlatFeatures(110, 50), 0, 1);
    const Halves more = NoisyHalves(truth, 0.2, 2);
    for (int c = 0; c < 3; ++c)
        for (int y = 0; y < 50; ++y)
            for (const auto half : {&Halves::a, &Halves::b})
                std::copy_n((more.*half).Row(c, y) + 60, 50, (noisy.colour.*half).Row(c, y) + 60);
    return noisy;
}

// Returns the mean of both halves.
inline Planes MeanOf(const Halves& halves) {
    Planes mean = halves.a;
    for (size_t i = 0; i < mean.values.size(); ++i)
        mean.values[i] = (mean.values[i] + halves.b.values[i]) / 2;
    return mean;
}

// Returns the root mean square of the difference of two images, over the pixels more than `border`
// from their border.
inline double Rms(const Planes& a, const Planes& b, int border = 0) {
    double sum = 0;
    int count = 0;
    for (int c = 0; c < a.count; ++c)
        for (int y = border; y < a.height - border; ++y)
            for (int x = border; x < a.width - border; ++x, ++count) {
                const double d = double(a.Row(c, y)[x]) - double(b.Row(c, y)[x]);
                sum += d * d;
            }
    return std::sqrt(sum / count);
}

inline double Rms(const Planes& image) {
    return Rms(image, Planes(image.width, image.height, image.count));
}

// Returns a grey picture of waves, with Gaussian texture of this deviation right of `from`.
inline Planes TexturedWaves(int side, double deviation, int from) {
    std::mt19937 generator(1);
    std::normal_distribution<double> gauss(0, deviation);
    const Planes texture =
        MakePlanes(side, side, 1, [&](int, int, int) { return gauss(generator); });
    return MakePlanes(side, side, 3, [&](int, int x, int y) {
        return 0.4 + 0.1 * std::sin(x * 0.15) + (x < from ? 0 : texture.Row(0, y)[x]);
    });
}

inline double SumOf(const Planes& planes) {
    double sum = 0;
    for (const float v : planes.values) sum += double(v);
    return sum;
}

}  // namespace lull
