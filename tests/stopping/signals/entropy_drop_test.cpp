#include "stopping/signals/entropy_drop.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <stdexcept>

#include "stopping/signals/history.h"
#include "stopping/signals/svd_entropy.h"
#include "tests/stopping/signals/block_images.h"

namespace lull {
namespace {

constexpr int kSide = 200, kSubBlocks = 100;

// Returns a grey block of lightness 61.7 with independent noise of standard deviation `noise` in L.
BlockImage GreyNoise(double noise, unsigned seed) {
    const double y = 0.3, slope = 116 / 3.0 * std::pow(y, -2 / 3.0);
    std::mt19937 generator(seed);
    std::normal_distribution<double> gauss(0, noise / slope);
    BlockImage image(kSide, kSide, float(y));
    for (size_t i = 0; i < image.mean.size(); i += 3)
        image.mean[i] = image.mean[i + 1] = image.mean[i + 2] = float(y + gauss(generator));
    return image;
}

std::vector<double> Entropies(const BlockView& view) {
    std::vector<double> h;
    for (const SvdEntropy& e : PictureEntropies(view, kSubBlocks)) h.push_back(e.h);
    return h;
}

// Returns the mean visible drop at `spp` of pictures whose noise is sqrt(40 / n^a) times as large
// as at 1 spp would be 1, after those at all looks before.
double VisibleAt(int spp, double scale, double a, const NoiseVisibility& visibility) {
    History<float> history;
    std::optional<std::vector<double>> visible;
    for (int n = 20; n <= spp; n += 40) {
        const BlockImage image = GreyNoise(scale * std::pow(n, -a / 2), unsigned(n));
        const BlockView view = image.At(n);
        AddEntropies(n, Entropies(view), &history);
        visible = LatestVisibleDrop(history, MeasureLightness(view, kSubBlocks), visibility);
    }
    double sum = 0;
    for (const double v : *visible) sum += v / double(visible->size());
    return sum;
}

constexpr NoiseVisibility kPlain = {.mask = 1e9, .flare = 0, .reference = 1 << 30, .nearness = 0.5};

TEST(EntropyDrop, IsTheNoiseButForAConstant) {
    // Whatever the noise is: 0.5 to 4 in L.
    std::vector<double> ratios;
    for (const double noise : {4.0, 2.0, 1.0, 0.5})
        ratios.push_back(VisibleAt(420, noise * std::sqrt(420), 1, kPlain) / noise);
    for (const double ratio : ratios) EXPECT_NEAR(ratio, 1.75, 0.35);
    EXPECT_LT(ratios[0], ratios[3]);  // it hardly changes, by the logarithm of the noise
}

TEST(EntropyDrop, MeansTheSameHoweverFastNoiseFalls) {
    const double random = VisibleAt(420, std::sqrt(420), 1, kPlain);
    for (const double a : {1.25, 1.5, 1.75}) {
        const double fast = VisibleAt(420, std::pow(420, a / 2), a, kPlain);
        EXPECT_NEAR(fast / random, 1, 0.08) << a;
        // Its value without the correction.
        EXPECT_GT(fast * std::sqrt(std::pow(2, a) - 1) / random, 1.1) << a;
    }
}

TEST(EntropyDrop, ReadsTheRateOfTheFall) {
    auto state = [](int spp, double a) {
        return EntropyState{spp, {float(0.2 + std::pow(spp, -a)), float(0.3)}};
    };
    const std::vector<double> weights = {1, 1};
    for (const double a : {1.0, 1.3, 1.6, 1.9})
        EXPECT_NEAR(RateOfFall(state(20, a), state(60, a), state(100, a), weights), a, 1e-3);
    EXPECT_EQ(RateOfFall(state(20, 0.5), state(60, 0.5), state(100, 0.5), weights), 1);
    EXPECT_EQ(RateOfFall(state(20, 2.5), state(60, 2.5), state(100, 2.5), weights), 2);
    // Where entropies rise ever more, or stay, nothing can be said.
    EXPECT_EQ(RateOfFall(state(20, -1), state(60, -1), state(100, -1), weights), 1);
    EXPECT_EQ(RateOfFall(state(20, 1), state(20, 1), state(20, 1), weights), 1);
    // A sub-block counts as its weight says.
    EntropyState odd = state(60, 1.3);
    odd.values[1] = 0.9f;
    EXPECT_NEAR(RateOfFall(state(20, 1.3), odd, state(100, 1.3), std::vector<double>{1, 0}), 1.3,
                1e-3);
}

TEST(EntropyDrop, IsBroughtToWhatIsLeft) {
    // Noise adds 1 / n; from 60 to 100 it falls by 1/60 - 1/100, and 1/100 is left.
    const EntropyState before{60, {float(0.2 + 1 / 60.0)}}, now{100, {float(0.2 + 1 / 100.0)}};
    EXPECT_NEAR(EntropyDrop(before, now, 1)[0], 0.1, 1e-5);
    // Fireflies that come make it rise: noise as well.
    const EntropyState risen{100, {float(0.2 + 1 / 60.0 + (1 / 60.0 - 1 / 100.0))}};
    EXPECT_NEAR(EntropyDrop(before, risen, 1)[0], 0.1, 1e-5);
}

TEST(VisibleDrop, CountsWhatIsSeen) {
    const std::vector<double> drop = {0.02, 0.02};
    const SubBlockLightness lightness{.mean = {60, 60}, .deviation = {0, 24}};
    const NoiseVisibility visibility{.mask = 24, .flare = 0, .reference = 10000, .nearness = 0.5};
    const auto at = [&](int spp) { return VisibleDrop(drop, lightness, spp, visibility); };
    EXPECT_NEAR(at(100)[0], 0.02 * 60 * std::sqrt(0.99), 1e-6);
    EXPECT_NEAR(at(100)[1], at(100)[0] / 2, 1e-9);
    EXPECT_NEAR(at(7500)[0], 0.02 * 60 * 0.5, 1e-6);
    EXPECT_EQ(at(10000)[0], 0);
    EXPECT_EQ(at(20000)[0], 0);
}

TEST(FlareFactor, HidesWhatIsDark) {
    EXPECT_DOUBLE_EQ(FlareFactor(50, 0), 1);
    double last = 0;
    for (const double l : {8.0, 20.0, 40.0, 60.0, 80.0, 100.0}) {
        const double factor = FlareFactor(l, 0.05);
        EXPECT_GE(factor, last) << l;
        EXPECT_LE(factor, 1) << l;
        last = factor;
    }
    for (const double l : {0.0, 4.0}) EXPECT_NEAR(FlareFactor(l, 0.05), 0.3, 0.03);
    // The derivative of the lightness of (Y + 0.05) / 1.05.
    auto lightness = [](double y) { return 116 * std::cbrt(y) - 16; };
    const double y = 0.1, e = 1e-6;
    const double expected = (lightness((y + e + 0.05) / 1.05) - lightness((y + 0.05) / 1.05)) /
                            (lightness(y + e) - lightness(y));
    EXPECT_NEAR(FlareFactor(lightness(y), 0.05), expected, 1e-5);
}

TEST(MeasureLightness, DescribesSubBlocks) {
    BlockImage image(40, 20, 0.3f);
    for (int y = 0; y < 20; ++y)
        for (int x = 20; x < 40; ++x)
            for (int c = 0; c < 3; ++c) image.Mean(x, y)[c] = (x + y) % 2 ? 1.f : 0.f;
    const SubBlockLightness lightness = MeasureLightness(image.At(20), 4);
    const double grey = 116 * std::cbrt(0.3) - 16;
    EXPECT_NEAR(lightness.mean[0], grey, 1e-3);
    EXPECT_NEAR(lightness.deviation[0], 0, 1e-2);
    EXPECT_NEAR(lightness.mean[1], 50, 1e-3);
    EXPECT_NEAR(lightness.deviation[3], 50, 1e-3);
    EXPECT_THROW(MeasureLightness(image.At(20), 5), std::invalid_argument);
    EXPECT_THROW(MeasureLightness(BlockImage(9, 40, 0).At(20), 100), std::invalid_argument);
    image.mean[0] = std::numeric_limits<float>::quiet_NaN();
    EXPECT_TRUE(std::isfinite(MeasureLightness(image.At(20), 4).mean[0]));
}

}  // namespace
}  // namespace lull
