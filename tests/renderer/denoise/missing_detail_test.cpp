#include "renderer/denoise/missing_detail.h"

#include <gtest/gtest.h>

#include "tests/renderer/denoise/example_pictures.h"

namespace lull {
namespace {

constexpr int kSide = 100;

// Returns residuals of denoised halves that lack `texture`, which the samples have, and differ by
// little.
CrossedResiduals Lacking(double noise, const std::function<double(int x, int y)>& texture,
                         unsigned seed, int side = kSide) {
    std::mt19937 generator(seed);
    std::normal_distribution<double> gauss;
    CrossedResiduals of;
    of.noise = of.half = of.a = of.b = Planes(side, side, 1);
    for (int y = 0; y < side; ++y)
        for (int x = 0; x < side; ++x) {
            const double noiseA = noise * gauss(generator), noiseB = noise * gauss(generator);
            of.a.Row(0, y)[x] = float(-texture(x, y) - noiseB);
            of.b.Row(0, y)[x] = float(-texture(x, y) - noiseA);
            of.noise.Row(0, y)[x] = float(noiseA - noiseB);
            of.half.Row(0, y)[x] = float(0.1 * noise * gauss(generator));
        }
    return of;
}

double Nothing(int, int) { return 0; }
double Waves(int x, int y) { return 2 * std::sin(1.1 * x) * std::cos(0.7 * y); }  // RMS 1

double RmsOf(const Planes& image) {
    double sum = 0;
    for (const float v : image.values) sum += double(v) * double(v);
    return std::sqrt(sum / double(image.values.size()));
}

TEST(MissingDetail, IsNotFoundInNoise) {
    int found = 0;
    for (unsigned seed = 1; seed <= 20; ++seed)
        found += RmsOf(MissingDetail(Lacking(3, Nothing, seed), 1.27f)) > 0;
    EXPECT_LE(found, 2);
}

TEST(MissingDetail, IsTextureThatWasRemoved) {
    for (const double noise : {0.5, 1., 2.}) {
        const Planes missing = MissingDetail(Lacking(noise, Waves, 1), 1.27f);
        EXPECT_GT(RmsOf(missing), 1) << noise;
        EXPECT_LT(RmsOf(missing), 2.5) << noise;
        double product = 0;  // where the noise is less than the texture, it is its pattern
        for (int y = 0; y < kSide; ++y)
            for (int x = 0; x < kSide; ++x)
                product += double(missing.Row(0, y)[x]) * Waves(x, y) / (kSide * kSide);
        if (noise <= 1) {
            EXPECT_GT(product, 0.7) << noise;
        }
    }
}

TEST(MissingDetail, IsNoneWhereTheHalvesTellAsMuch) {
    CrossedResiduals of = Lacking(0.5, Waves, 1);
    for (int y = 0; y < kSide; ++y)
        for (int x = 0; x < kSide; ++x) of.half.Row(0, y)[x] = float(Waves(x, y));
    EXPECT_EQ(RmsOf(MissingDetail(of, 1.27f)), 0);
}

TEST(MissingDetail, IsNoneInBlocksThatAreTooSmallToTell) {
    const Planes missing = MissingDetail(Lacking(0.1, Waves, 1, 7), 1);
    EXPECT_EQ(missing.values, Planes(7, 7, 1).values);
}

}  // namespace
}  // namespace lull
