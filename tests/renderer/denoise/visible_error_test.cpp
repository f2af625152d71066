#include "renderer/denoise/visible_error.h"

#include <gtest/gtest.h>

#include "tests/renderer/denoise/example_pictures.h"

namespace lull {
namespace {

constexpr int kImageSide = 120;
PixelRect Whole(int side) { return {{0, 0}, {side, side}}; }

VisibleError ErrorOf(const DenoisedPicture& denoised) {
    return MeasureVisibleError(denoised, MeasureError(denoised), Whole(denoised.picture.width));
}

// Noise and texture that is blurred, at noise that falls: the estimate follows the truth, without
// bias on average, to 0.46 of it in one image, and the bound is seldom exceeded.
TEST(VisibleError, IsKnownWithoutAReference) {
    const Planes truth = TexturedWaves(kImageSide, 0.015, kImageSide / 2);
    int above = 0, count = 0;
    double last = 1e9, octaves = 0;
    for (const double noise : {0.2, 0.1, 0.04, 0.01})
        for (unsigned seed = 1; seed <= 2; ++seed, ++count) {
            const DenoisedPicture denoised =
                Denoise(AddNoise(truth, FlatFeatures(kImageSide, kImageSide), noise, seed));
            const VisibleError error = ErrorOf(denoised);
            const double expected = PooledDifference(
                FindVisibleDifference(Interleaved(denoised.picture), Interleaved(truth), kImageSide,
                                      kImageSide, DisplayModel()));
            EXPECT_NEAR(std::log2(error.estimate / expected), 0, 1.2) << noise << " " << expected;
            octaves += std::log2(error.estimate / expected);
            EXPECT_LE(error.estimate, error.upper);
            if (seed == 1) {
                EXPECT_LT(error.upper, last) << noise;
                last = error.upper;
            }
            above += expected > error.upper;
        }
    EXPECT_LE(above, count / 4);
    EXPECT_NEAR(octaves / count, 0, 0.15);
}

// A block whose picture lacks one line of 60 pixels is not clean; the mean of its errors would be.
TEST(VisibleError, CountsALineThatIsMissing) {
    const Planes flat(200, 200, 3, 0.2f);
    const DenoisedPicture denoised{
        flat, {flat, flat}, {flat, flat}, Planes(200, 200, 3, 1e-6f), Planes(200, 200, 1), {}};
    EstimatedError error = MeasureError(denoised);
    EXPECT_LT(MeasureVisibleError(denoised, error, Whole(200)).upper, 0.01);
    for (int x = 70; x < 130; ++x) error.structure.Row(0, 100)[x] = -6;
    EXPECT_GT(MeasureVisibleError(denoised, error, Whole(200)).upper, kAcceptedDifference);
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

TEST(MissingDetail, IsNotFoundInNoise) {
    int found = 0;
    for (unsigned seed = 1; seed <= 20; ++seed)
        found += Rms(MissingDetail(Lacking(3, Nothing, seed), 1.27f)) > 0;
    EXPECT_LE(found, 2);
}

TEST(MissingDetail, IsTextureThatWasRemoved) {
    for (const double noise : {0.5, 1., 2.}) {
        const Planes missing = MissingDetail(Lacking(noise, Waves, 1), 1.27f);
        EXPECT_GT(Rms(missing), 1) << noise;
        EXPECT_LT(Rms(missing), 2.5) << noise;
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
    EXPECT_EQ(Rms(MissingDetail(of, 1.27f)), 0);
}

TEST(MissingDetail, IsNoneInBlocksThatAreTooSmallToTell) {
    EXPECT_EQ(MissingDetail(Lacking(0.1, Waves, 1, 7), 1).values, Planes(7, 7, 1).values);
}

// Returns the worst pixels of a grey picture whose pixels of these indices are lighter or darker.
std::vector<size_t> WorstOf(int side, const std::vector<std::pair<size_t, float>>& differences) {
    std::vector<float> grey(size_t(3 * side * side), 0.2f), other = grey,
                                                            lightness(size_t(side * side));
    for (const auto& [pixel, difference] : differences) {
        for (size_t c = 0; c < 3; ++c) other[3 * pixel + c] += difference;
        lightness[pixel] = 100 * difference;
    }
    return WorstPixels(FindVisibleDifference(other, grey, side, side, DisplayModel()), lightness);
}

// The pixels around one that is wrong differ visibly, too, but are right.
TEST(WorstPixels, AreThoseThatAreWrong) {
    constexpr int kSide = 100;  // two of whose pixels are taken
    EXPECT_EQ(WorstOf(kSide, {{2020, 0.2f}, {7070, -0.19f}, {5050, 0.1f}}),
              (std::vector<size_t>{2020, 7070}));
}

TEST(WorstPixels, AreNoneOfSmallBlocks) { EXPECT_TRUE(WorstOf(60, {{1830, 0.2f}}).empty()); }

}  // namespace
}  // namespace lull
