#include "renderer/denoise/visible_error.h"

#include <gtest/gtest.h>

#include <cmath>

#include "renderer/denoise/denoiser.h"
#include "tests/renderer/denoise/example_pictures.h"

namespace lull {
namespace {

double LightnessOf(double y) { return y > 0.008856 ? 116 * std::cbrt(y) - 16 : 903.3 * y; }

// Returns the root mean square, over the picture, of what two grey pictures differ by in lightness,
// as it is seen.
double TrueError(const Planes& picture, const Planes& truth) {
    Planes difference(picture.width, picture.height, 1);
    for (size_t i = 0; i < picture.Area(); ++i)
        difference.values[i] = float(LightnessOf(std::min(1.f, picture.values[i])) -
                                     LightnessOf(std::min(1.f, truth.values[i])));
    return Rms(AsSeen(std::move(difference)));
}

// Noise and what is blurred, at noise that falls: the estimate follows the truth, and the bound is
// seldom exceeded. Flare and detail make what is seen smaller than what there is.
TEST(LightnessError, IsKnownWithoutAReference) {
    const Planes truth = TexturedWaves(120, 0.015, 60);
    int above = 0, count = 0;
    for (const double noise : {0.2, 0.1, 0.04})
        for (unsigned seed = 1; seed <= 2; ++seed, ++count) {
            const DenoisedPicture denoised =
                Denoise(AddNoise(truth, FlatFeatures(120, 120), noise, seed));
            const LightnessError error =
                MeasureLightnessError(MeasureError(denoised), {{0, 0}, {120, 120}});
            const double seen = 0.8;  // at L = 70 with detail of some 3 to 6
            const double expected = seen * TrueError(denoised.picture, truth);
            EXPECT_LE(error.least, error.estimate);
            EXPECT_LE(error.estimate, error.upper);
            EXPECT_LT(error.least, 1.3 * expected);
            if (noise < 0.15) {
                EXPECT_NEAR(error.estimate / expected, 1, 0.5) << noise;
            }
            above += expected > error.upper;
        }
    EXPECT_LE(above, count / 4);
}

// On average the estimate is the truth: the half that judges has no part in what it judges but for
// the weights.
TEST(LightnessError, IsEstimatedWithoutBias) {
    const Planes truth = TexturedWaves(120, 0.02, 0);
    double said = 0, real = 0;
    for (unsigned seed = 1; seed <= 6; ++seed) {
        const DenoisedPicture denoised =
            Denoise(AddNoise(truth, FlatFeatures(120, 120), 0.05, seed));
        const EstimatedError error = MeasureError(denoised);
        for (size_t i = 0; i < error.squared.Area(); ++i)
            said += double(error.squared.values[i]) / double(error.squared.Area());
        real += std::pow(TrueError(denoised.picture, truth), 2);
    }
    EXPECT_NEAR(said / real, 1, 0.15);
}

// One part of which little is known, as its noise is strong, leaves the bound of all others alone.
TEST(LightnessError, IsBoundedDespiteOneNoisyPart) {
    EstimatedError error{Planes(100, 100, 1, 50), Planes(100, 100, 1, 1), Planes(100, 100, 1, 0.5f),
                         Planes(100, 100, 1),     Planes(100, 100, 1),    {}};
    const double calm = MeasureLightnessError(error, {{0, 0}, {100, 100}}).upper;
    for (int y = 0; y < 10; ++y)
        for (int x = 0; x < 10; ++x) error.deviation.Row(0, y)[x] = 200;
    const LightnessError noisy = MeasureLightnessError(error, {{0, 0}, {100, 100}});
    EXPECT_LT(noisy.upper, 1.12 * calm);
    EXPECT_GT(noisy.upper, calm);
}

TEST(LightnessError, IsNothingWhereNothingIsWrong) {
    const Planes truth(50, 50, 3, 0.3f);
    const DenoisedPicture denoised = Denoise(AddNoise(truth, FlatFeatures(50, 50), 0, 1));
    const EstimatedError error = MeasureError(denoised);
    EXPECT_LT(MeasureLightnessError(error, {{0, 0}, {50, 50}}).upper, 0.02);
    for (const float e : StandardError(denoised, error.structure).values) EXPECT_LT(e, 0.02f);
}

TEST(LightnessError, IsNotSeenAboveWhite) {
    const DenoisedPicture denoised =
        Denoise(AddNoise(Planes(50, 50, 3, 5), FlatFeatures(50, 50), 0.5, 1));
    EXPECT_EQ(MeasureLightnessError(MeasureError(denoised), {{0, 0}, {50, 50}}).upper, 0);
}

// Blotches count about twice as much as noise between single pixels.
TEST(LightnessError, SeesWhatIsCoarse) {
    std::mt19937 generator(1);
    std::normal_distribution<double> gauss(0, 1);
    const Planes noise = MakePlanes(120, 120, 1, [&](int, int, int) { return gauss(generator); });
    EXPECT_NEAR(Rms(AsSeen(noise)) / Rms(noise), 1.03, 0.01);
    const Planes blotches = BoxMean(BoxMean(noise, 5), 5);
    EXPECT_GT(Rms(AsSeen(blotches)) / Rms(blotches), 1.8);
}

TEST(LightnessError, IsThatOfTheBlock) {
    const EstimatedError error = MeasureError(Denoise(NoiseOnTheRight()));
    EXPECT_LT(MeasureLightnessError(error, {{0, 0}, {50, 50}}).upper, 0.05);
    EXPECT_GT(MeasureLightnessError(error, {{60, 0}, {110, 50}}).upper, 0.1);
}

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
        const DenoisedImage result = RunDenoiser(AddNoise(dark, FlatFeatures(30, 20), 0.003, 1),
                                                 {&block, 1}, {.gradings = std::move(gradings)});
        EXPECT_NEAR(result.image.values[0], 0.01f, 0.005f);
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
