#include "renderer/denoise/denoise.h"

#include <gtest/gtest.h>

#include "renderer/denoise/visible_error.h"
#include "tests/renderer/denoise/example_pictures.h"

namespace lull::structure_test {
namespace {

constexpr int kWidth = 160, kHeight = 120;

double LightnessOf(double y) { return 116 * std::cbrt(y) - 16; }

Planes Variance(const Planes& truth, double deviation) {
    return Planes(truth.width, truth.height, 3, float(deviation * deviation));
}

double ShareFound(const Planes& left) {
    return double(std::ranges::count_if(left.values, [](float v) { return v != 0; })) /
           double(left.Area());
}

// A picture that is the truth leaves noise alone in the residual: Gaussian, of heavy tails, white
// windows, and of twice the variance that is known.
TEST(Structure, IsNotFoundInNoise) {
    const Planes truth = MakePlanes(kWidth, kHeight, 3, [](int, int x, int y) {
        return x > 40 && x < 70 && y > 30 && y < 80 ? 3.0 : x < 100 ? 0.4 : 0.05;
    });
    std::mt19937 generator(1);
    std::uniform_real_distribution<double> uniform;
    for (const double noise : {0.3, 0.05, 0.005}) {
        Halves noisy = NoisyHalves(truth, noise, 1);
        for (Planes* half : {&noisy.a, &noisy.b})  // as in dark parts noise is cut at 0
            for (size_t i = 0; i < half->values.size(); ++i)
                if (truth.values[i] < 0.1f) half->values[i] = truth.values[i];
        EXPECT_LT(ShareFound(StructureLeft(noisy, Variance(truth, noise), {truth, truth})), 2e-3);
        EXPECT_LT(ShareFound(StructureLeft(noisy, Variance(truth, noise / 2), {truth, truth})),
                  4e-3);
        Halves heavy{truth, truth};
        for (Planes* half : {&heavy.a, &heavy.b})
            for (size_t i = 0; i < truth.Area(); ++i) {
                // One in fifty pixels has all the light that others lack.
                const double light = uniform(generator) < 0.02 ? 1 + 49 * noise : 1 - noise;
                for (int c = 0; c < 3; ++c) half->Plane(c)[i] = truth.Plane(c)[i] * float(light);
            }
        EXPECT_LT(ShareFound(StructureLeft(heavy, Variance(truth, noise), {truth, truth})), 3e-2)
            << noise;
    }
}

// A line and a patch that the picture lacks are given back, and nothing else changes.
TEST(Structure, IsGivenBack) {
    const Planes flat(kWidth, kHeight, 3, 0.3f);
    const auto isPattern = [](int x, int y) {
        return std::abs(y - 40 - x / 4) < 2 || (x > 100 && x < 112 && y > 90 && y < 102);
    };
    const Planes truth = MakePlanes(kWidth, kHeight, 3,
                                    [&](int, int x, int y) { return isPattern(x, y) ? 0.2 : 0.3; });
    const double noise = 0.05;
    const Halves noisy = NoisyHalves(truth, noise, 2);
    Halves picture{flat, flat};
    const Planes before = StructureLeft(noisy, Variance(truth, noise), picture);
    EXPECT_NEAR(double(before.Row(0, 96)[106]), LightnessOf(0.2) - LightnessOf(0.3), 3);
    RestoreStructure(noisy, Variance(truth, noise), &picture);
    EXPECT_LT(ShareFound(StructureLeft(noisy, Variance(truth, noise), picture)),
              ShareFound(before) / 8);
    double inside = 0, outside = 0;
    int count = 0;
    for (int y = 0; y < kHeight; ++y)
        for (int x = 0; x < kWidth; ++x) {
            const double value = double(picture.a.Row(1, y)[x]);
            if (isPattern(x, y))
                inside += value, ++count;
            else
                outside += value;
        }
    EXPECT_NEAR(LightnessOf(inside / count), LightnessOf(0.2), 3);
    EXPECT_NEAR(outside / (kWidth * kHeight - count), 0.3, 0.005);
}

// Where one pixel in fifty has most of the light, those between them are darker than the picture,
// as they should be.
TEST(Structure, LeavesTheLightOfRarePaths) {
    std::mt19937 generator(3);
    std::uniform_real_distribution<double> uniform;
    const Planes truth(kWidth, kHeight, 3, 0.2f);
    Halves noisy{truth, truth};
    for (Planes* half : {&noisy.a, &noisy.b})
        for (size_t i = 0; i < truth.Area(); ++i) {
            const float light = uniform(generator) < 0.02 ? 5.2f : 0.1f;
            for (int c = 0; c < 3; ++c) half->Plane(c)[i] = light;
        }
    Halves picture{truth, truth};
    RestoreStructure(noisy, Variance(truth, 0.7), &picture);
    EXPECT_NEAR(SumOf(picture.a) / SumOf(truth), 1, 0.01);
}

TEST(SampleRange, IsThatOfTheNeighbourhood) {
    const Planes noisy = MakePlanes(
        30, 20, 3, [](int c, int x, int y) { return (x * 7 + y * 13 + c * 5) % 31 * 0.1; });
    const ImageTile tile{3, 0, 30, 17};
    const SampleRange range = RangeOfSamples(noisy, tile);
    for (int c = 0; c < 3; ++c)
        for (int y = tile.y0; y < tile.y1; ++y)
            for (int x = tile.x0; x < tile.x1; ++x) {
                float least = 1e9f, most = -1;
                for (int v = std::max(0, y - 7); v < std::min(20, y + 8); ++v)
                    for (int u = std::max(0, x - 7); u < std::min(30, x + 8); ++u) {
                        const float sample = noisy.Row(c, v)[u];
                        most = std::max(most, sample);
                        if (std::max(std::abs(u - x), std::abs(v - y)) <= 2)
                            least = std::min(least, sample);
                    }
                ASSERT_EQ(range.least.Row(c, y)[x - 3], least);
                ASSERT_EQ(range.most.Row(c, y)[x - 3], most);
            }
}

// A bright edge whose noise depends on a feature, as behind a jug: lines fitted to it go below what
// any sample has.
TEST(Denoise, LeavesNoHolesBesideWhatIsBright) {
    const auto isBright = [](int x, int y) { return y < 40 + x / 5; };
    const Planes truth = MakePlanes(kWidth, kHeight, 3, [&](int, int x, int y) {
        return isBright(x, y) ? 200.0 * std::exp(-std::abs(y - 40 - x / 5) / 3.0) + 5 : 5;
    });
    NoisyPicture noisy = AddNoise(truth, FlatFeatures(kWidth, kHeight), 0, 4);
    std::mt19937 generator(4);
    std::exponential_distribution<double> light;
    for (Planes* half : {&noisy.colour.a, &noisy.colour.b})
        for (size_t i = 0; i < truth.Area(); ++i) {
            const float share = float(0.5 + 0.5 * light(generator));
            for (int c = 0; c < 3; ++c) half->Plane(c)[i] *= share;
        }
    const Planes picture = Denoise(std::move(noisy)).picture;
    for (const float v : picture.values) ASSERT_GE(v, 2.5f);
}

}  // namespace
}  // namespace lull::structure_test
