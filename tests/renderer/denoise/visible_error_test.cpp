#include "renderer/denoise/visible_error.h"

#include <gtest/gtest.h>

#include "renderer/vision/visible_difference.h"
#include "tests/renderer/denoise/example_pictures.h"

namespace lull {
namespace {

constexpr int kImageSide = 120;
PixelRect Whole(int side) { return {{0, 0}, {side, side}}; }

VisibleError ErrorOf(const DenoisedPicture& denoised) {
    return MeasureVisibleError(denoised, MeasureError(denoised), Whole(denoised.picture.width));
}

// Noise and texture that is blurred, at noise that falls: the estimate follows the truth, and the
// bound is seldom exceeded.
TEST(VisibleError, IsKnownWithoutAReference) {
    std::mt19937 generator(1);
    std::normal_distribution<double> gauss(0, 0.015);
    const Planes texture =
        MakePlanes(kImageSide, kImageSide, 1, [&](int, int, int) { return gauss(generator); });
    const Planes truth = MakePlanes(kImageSide, kImageSide, 3, [&](int, int x, int y) {
        return 0.4 + 0.1 * std::sin(x * 0.15) + (x < kImageSide / 2 ? 0 : texture.Row(0, y)[x]);
    });
    int above = 0, count = 0;
    double last = 1e9;
    for (const double noise : {0.2, 0.1, 0.04, 0.01})
        for (unsigned seed = 1; seed <= 2; ++seed, ++count) {
            const DenoisedPicture denoised =
                Denoise(AddNoise(truth, FlatFeatures(kImageSide, kImageSide), noise, seed));
            const VisibleError error = ErrorOf(denoised);
            const double expected = PooledDifference(
                FindVisibleDifference(Interleaved(denoised.picture), Interleaved(truth), kImageSide,
                                      kImageSide, DisplayModel()));
            EXPECT_NEAR(std::log2(error.estimate / expected), 0, 1) << noise << " " << expected;
            EXPECT_LE(error.estimate, error.upper);
            if (seed == 1) {
                EXPECT_LT(error.upper, last) << noise;
                last = error.upper;
            }
            above += expected > error.upper;
        }
    EXPECT_LE(above, count / 4);
}

TEST(VisibleError, IsNothingWhereNothingIsWrong) {
    EXPECT_LT(ErrorOf(Denoise(AddNoise(Planes(50, 50, 3, 0.3f), FlatFeatures(50, 50), 0, 1))).upper,
              0.001);
}

TEST(VisibleError, IsNotSeenAboveWhite) {
    EXPECT_EQ(ErrorOf(Denoise(AddNoise(Planes(50, 50, 3, 5), FlatFeatures(50, 50), 0.5, 1))).upper,
              0);
}

// A block whose picture lacks one line of 60 pixels is not clean; the mean of its errors would be.
TEST(VisibleError, CountsALineThatIsMissing) {
    const Planes flat(200, 200, 3, 0.2f);
    const DenoisedPicture denoised{
        flat, {flat, flat}, {flat, flat}, Planes(200, 200, 3, 1e-6f), Planes(200, 200, 1), {}};
    EstimatedError error = MeasureError(denoised);
    EXPECT_LT(MeasureVisibleError(denoised, error, Whole(200)).upper, 0.01);
    for (int x = 70; x < 130; ++x) error.structure.Row(0, 100)[x] = -6;
    EXPECT_GT(MeasureVisibleError(denoised, error, Whole(200)).upper, kAcceptedBound);
}

// One rare path, whose light is taken off and spread, leaves the bound of its block to the others;
// the doubt about its light stays.
TEST(VisibleError, IsNotThatOfOnePathWhichIsTaken) {
    constexpr float kNoise = 0.05f, kPath = 20;
    constexpr int kSmall = 60, kMiddle = 30;
    const Planes truth(kSmall, kSmall, 3, 0.3f);
    NoisyPicture without = AddNoise(truth, FlatFeatures(kSmall, kSmall), kNoise, 1);
    without.variance = Planes(kSmall, kSmall, 1, Sqr(kNoise) / 2);
    NoisyPicture with = without;
    for (int c = 0; c < 3; ++c) with.colour.a.Row(c, kMiddle)[kMiddle] += kPath;
    with.variance.Row(0, kMiddle)[kMiddle] = Sqr(kPath / 2);
    const DenoisedPicture denoised = Denoise(with);
    EXPECT_LT(ErrorOf(denoised).upper, 1.3 * ErrorOf(Denoise(without)).upper);
    EXPECT_GT(denoised.returned.Row(0, kMiddle)[kMiddle], 0.5 * kPath / 2 / (81 * 81));
    EXPECT_LT(denoised.variance.Row(0, kMiddle)[kMiddle], 0.1f);
}

// Returns a grey picture whose halves differ in lightness by noise, and by much in some pixels.
DenoisedPicture WithWildPixels(int side, int count) {
    constexpr float kGrey = 0.2f, kNoise = 0.002f, kWild = 0.15f;
    std::mt19937 generator(1);
    std::normal_distribution<float> gauss(0, kNoise);
    const Planes flat(side, side, 3, kGrey);
    DenoisedPicture denoised{
        flat, {flat, flat}, {flat, flat}, Planes(side, side, 3, 1e-6f), Planes(side, side, 1), {}};
    for (int i = 0; i < side * side; ++i) {
        const bool isWild = count > 0 && i % (side * side / count) == side * side / 200;
        const float half = isWild ? kWild : gauss(generator);
        for (int c = 0; c < 3; ++c) {
            denoised.halves.a.Plane(c)[i] += half;
            denoised.halves.b.Plane(c)[i] -= half;
        }
    }
    denoised.noisy = denoised.halves;
    return denoised;
}

// Few pixels that are still wrong do not decide for a block; they are told apart. Many do.
TEST(VisibleError, IsNotThatOfFewPixels) {
    constexpr int kSide = 130;
    const VisibleError without = ErrorOf(WithWildPixels(kSide, 0)),
                       few = ErrorOf(WithWildPixels(kSide, 3)),
                       many = ErrorOf(WithWildPixels(kSide, 60));
    EXPECT_EQ(without.worstPixels, 0);
    EXPECT_EQ(without.worst, 0);
    EXPECT_LT(few.upper, 1.2 * without.upper);
    EXPECT_EQ(few.worstPixels, 3);
    EXPECT_GT(few.worst, 20);
    EXPECT_LT(few.worst, 80);
    EXPECT_GT(many.upper, 2 * without.upper);
}

// Of two halves of a picture the noisy one has the error.
TEST(VisibleError, IsThatOfTheBlock) {
    const DenoisedPicture denoised = Denoise(NoiseOnTheRight());
    const EstimatedError error = MeasureError(denoised);
    EXPECT_LT(MeasureVisibleError(denoised, error, Whole(50)).upper, 0.1);
    EXPECT_GT(MeasureVisibleError(denoised, error, {{60, 0}, {110, 50}}).upper, 0.3);
}

}  // namespace
}  // namespace lull
