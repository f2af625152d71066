#include "renderer/denoise/denoiser.h"

#include <gtest/gtest.h>

#include "tests/renderer/denoise/example_pictures.h"

namespace lull::dependence_test {
namespace {

constexpr int kWidth = 150, kHeight = 110;

Planes Picture(const std::function<double(int c, int x, int y)>& value) {
    return MakePlanes(kWidth, kHeight, 3, value);
}

// Noise that is as strong as light, relative to the truth; with heavy tails, one in twenty pixels
// has nearly all of it.
Planes Noisy(const Planes& truth, double relative, bool isHeavy, unsigned seed) {
    std::mt19937 generator(seed);
    std::normal_distribution<double> gauss(0, relative);
    std::exponential_distribution<double> rare(1);
    std::uniform_real_distribution<double> uniform;
    Planes noisy = truth;
    for (size_t i = 0; i < truth.Area(); ++i) {
        double factor = 1 + gauss(generator);
        if (isHeavy && uniform(generator) < 0.05) factor += 10 * relative * rare(generator);
        for (int c = 0; c < 3; ++c)
            noisy.Plane(c)[i] = std::max(0.f, truth.Plane(c)[i] * float(factor));
    }
    return noisy;
}

// Values that change from pixel to pixel, but not so that each has one of its own.
double Hash(int x, int y) {
    std::mt19937 generator(unsigned(x * 7919 + y * 104729));
    generator.discard(3);
    return double(generator()) / 4294967296.0;
}

std::vector<std::pair<const char*, Planes>> Truths() {
    return {
        {"smooth", Picture([](int, int x, int y) { return 0.3 + 0.001 * x + 0.0005 * y; })},
        {"dark", Picture([](int, int x, int) { return 1e-3 + 1e-5 * x; })},
        {"checkers",
         Picture([](int c, int x, int y) { return (x / 3 + y / 5 + c) % 2 ? 0.7 : 0.1; })},
        {"stripes of a pixel", Picture([](int, int x, int) { return x % 2 ? 0.7 : 0.1; })},
        {"gravel", Picture([](int, int x, int y) {
             return 0.2 + 0.4 * (Hash(x / 2, y / 2) + Hash((x + 1) / 2, (y + 1) / 2)) / 2;
         })},
        {"grain beside a wall",
         Picture([](int, int x, int y) { return 0.3 + (x > 20 ? 0.2 * Hash(x, y) : 0); })},
        {"saturated", Picture([](int, int x, int) { return x < 120 ? 5.0 : 0.5; })},
        {"half of it black", Picture([](int, int x, int) { return x < 75 ? 0.0 : 0.5; })},
    };
}

TEST(Dependence, IsNotSeenInIndependentHalves) {
    for (const auto& [name, truth] : Truths())
        for (const double noise : {1.0, 0.3, 0.05, 0.01, 1e-3, 1e-4})
            for (const bool isHeavy : {false, true})
                for (const unsigned seed : {1u, 2u, 3u}) {
                    const Halves halves{Noisy(truth, noise, isHeavy, 2 * seed),
                                        Noisy(truth, noise, isHeavy, 2 * seed + 1)};
                    EXPECT_EQ(DependenceOf(halves), "") << name << " " << noise << " " << isHeavy;
                }
}

// Other counts of samples in either half are no fault, up to some four times as many.
TEST(Dependence, IsNotSeenInHalvesOfDifferentSizes) {
    for (const auto& [name, truth] : Truths())
        for (const double noise : {0.3, 0.05, 1e-3}) {
            const Planes a = Noisy(truth, noise, false, 1), b = Noisy(truth, 2 * noise, false, 2);
            EXPECT_EQ(DependenceOf({a, b}), "") << name << " " << noise;
            EXPECT_EQ(DependenceOf({b, a}), "") << name << " " << noise;
        }
}

TEST(Dependence, IsSeenInCopies) {
    for (const auto& [name, truth] : Truths()) {
        const Planes a = Noisy(truth, 0.3, false, 1);
        EXPECT_NE(DependenceOf({a, a}), "") << name;
    }
    const Planes black(kWidth, kHeight, 3), white(kWidth, kHeight, 3, 1);
    EXPECT_EQ(DependenceOf({black, black}), "");
    EXPECT_EQ(DependenceOf({white, white}), "");
}

// Copies that were scaled, rounded to 11 bits, or have a little noise of their own.
TEST(Dependence, IsSeenInNoiseThatBothHave) {
    for (const double noise : {1.0, 0.3, 0.05})
        for (const bool isHeavy : {false, true})
            for (const bool isFiltered : {false, true}) {
                const Planes truth = Picture([](int, int x, int) { return 0.2 + 0.001 * x; });
                Planes a = Noisy(truth, noise, isHeavy, 1);
                if (isFiltered) a = BoxMean(std::move(a), 1);
                Planes scaled = a, rounded = a;
                for (float& v : scaled.values) v *= 1.0001f;
                for (float& v : rounded.values) {
                    int exponent;
                    const float mantissa = std::frexp(v, &exponent);
                    v = std::ldexp(std::round(mantissa * 2048) / 2048, exponent);
                }
                EXPECT_NE(DependenceOf({a, scaled}), "") << noise << isHeavy << isFiltered;
                if (isFiltered) continue;
                EXPECT_NE(DependenceOf({a, rounded}), "") << noise << isHeavy;
                const Halves own{Noisy(a, noise / 10, false, 2), Noisy(a, noise / 10, false, 3)};
                EXPECT_NE(DependenceOf(own), "") << noise << isHeavy;
            }
}

// The mean so far, and the mean of twice as many samples, of which these are half.
TEST(Dependence, IsSeenInSamplesThatBothHave) {
    for (const auto& [name, truth] : Truths())
        for (const double noise : {0.3, 0.1}) {
            const Planes a = Noisy(truth, noise, false, 1), b = Noisy(truth, noise, false, 2);
            const Planes both = MeanOf({a, b});
            EXPECT_NE(DependenceOf({a, both}), "") << name << " " << noise;
            EXPECT_NE(DependenceOf({both, a}), "") << name << " " << noise;
        }
}

TEST(Dependence, IsNotLookedForInTinyPictures) {
    for (const int size : {1, 2, 17, 40}) {
        const Planes truth(size, size, 3, 0.4f);
        EXPECT_EQ(DependenceOf(NoisyHalves(truth, 0.1, 1)), "");
    }
}

}  // namespace
}  // namespace lull::dependence_test
