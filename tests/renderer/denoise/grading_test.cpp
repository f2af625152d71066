#include "renderer/denoise/grading.h"

#include <gtest/gtest.h>

#include <cmath>

#include "renderer/denoise/denoiser.h"
#include "tests/renderer/denoise/example_pictures.h"

namespace lull {
namespace {

// Channels differ.
DenoisedPicture Example() {
    const Planes truth =
        MakePlanes(30, 20, 3, [](int c, int x, int) { return 0.1 * (c + 1) + 0.01 * x; });
    return Denoise(AddNoise(truth, FlatFeatures(30, 20), 0.02, 1));
}

const Grading kDouble = [](std::span<float> rgb) {
    for (float& v : rgb) v *= 2;
};
const Grading kRoot = [](std::span<float> rgb) {
    for (float& v : rgb) v = std::sqrt(v);
};

TEST(Graded, ScalesNoiseAsTheColours) {
    const DenoisedPicture linear = Example(), shown = Graded(linear, kDouble);
    for (size_t i = 0; i < linear.picture.values.size(); ++i) {
        EXPECT_FLOAT_EQ(shown.picture.values[i], 2 * linear.picture.values[i]);
        EXPECT_NEAR(shown.halves.a.values[i], 2 * linear.halves.a.values[i], 1e-4f);
        EXPECT_NEAR(shown.noisy.b.values[i], 2 * linear.noisy.b.values[i], 1e-4f);
        EXPECT_NEAR(shown.variance.values[i], 4 * linear.variance.values[i], 1e-5f);
    }
    EXPECT_EQ(Graded(linear, {}).noisy.a.values, linear.noisy.a.values);
}

TEST(Graded, TakesNoiseByTheSlope) {
    const DenoisedPicture linear = Example(), shown = Graded(linear, kRoot);
    for (size_t i = 0; i < linear.picture.values.size(); ++i) {
        const float root = std::sqrt(linear.picture.values[i]);
        EXPECT_FLOAT_EQ(shown.picture.values[i], root);
        const float noise = linear.noisy.a.values[i] - linear.picture.values[i];
        EXPECT_NEAR(shown.noisy.a.values[i] - root, noise / (2 * root),
                    0.05f * std::abs(noise) / root)
            << i;
    }
}

// Lifting a dark picture shows more of its noise.
TEST(RunDenoiser, MeasuresThePictureAsItIsShown) {
    const auto upper = [](std::vector<Grading> gradings) {
        const PixelRect block{{0, 0}, {30, 20}};
        const Planes dark(30, 20, 3, 0.01f);
        const DenoiserResult result = RunDenoiser(AddNoise(dark, FlatFeatures(30, 20), 0.003, 1),
                                                  {&block, 1}, {.gradings = std::move(gradings)});
        EXPECT_NEAR(result.rgb[0], 0.01f, 0.005f);
        return result.blocks.at(0).value().upper;
    };
    const Grading lift = [](std::span<float> rgb) {
        for (float& v : rgb) v *= 16;
    };
    const double plain = upper({}), lifted = upper({lift});
    EXPECT_GT(lifted, 1.5 * plain);
    EXPECT_EQ(upper({{}}), plain);
    EXPECT_EQ(upper({{}, lift}), lifted);
    EXPECT_EQ(upper({lift, {}}), lifted);
}

}  // namespace
}  // namespace lull
