#include "renderer/denoise/fireflies.h"

#include <gtest/gtest.h>

#include "tests/renderer/denoise/example_pictures.h"

namespace lull {
namespace {

Planes Grey(double value) {
    return MakePlanes(120, 100, 3, [=](int, int, int) { return value; });
}

TEST(Fireflies, AreTakenAndGivenBack) {
    Halves halves = NoisyHalves(Grey(0.3), 0.05, 1);
    for (int c = 0; c < 3; ++c) halves.a.Row(c, 40)[60] = 40;
    const std::vector<Firefly> fireflies = TakeFireflies(8, &halves);
    EXPECT_LT(halves.a.Row(1, 40)[60], 1.5f);
    double excess = 0;
    for (const Firefly& f : fireflies) excess += double(f.excess.sum());
    EXPECT_NEAR(excess / 3, 20, 1);

    Planes picture = Grey(0.3);
    const double before = SumOf(picture);
    GiveBack(fireflies, &picture);
    EXPECT_NEAR((SumOf(picture) - before) / excess, 1, 1e-4);
    float most = 0;
    for (const float v : picture.values) most = std::max(most, v);
    EXPECT_LT(most, 0.32f);
    EXPECT_FLOAT_EQ(picture.Row(0, 99)[0], 0.3f);  // too far away
}

TEST(Fireflies, AreNotWhatBothHalvesSee) {
    Halves halves = NoisyHalves(Grey(0.3), 0.05, 2);
    Planes &a = halves.a, &b = halves.b;
    for (int c = 0; c < 3; ++c) {
        a.Row(c, 40)[60] = 500, b.Row(c, 40)[60] = 499.8f;
        for (int x = 80; x < 90; ++x)  // a lamp, whose edge the halves cover differently
            a.Row(c, 20)[x] = b.Row(c, 20)[x] = 100;
        a.Row(c, 20)[90] = 60, b.Row(c, 20)[90] = 40;
    }
    EXPECT_TRUE(TakeFireflies(8, &halves).empty());
    EXPECT_EQ(a.Row(0, 40)[60], 500);
    EXPECT_EQ(a.Row(0, 20)[90], 60);
}

// Their noise is that of how often each half has met them.
TEST(Fireflies, AreNotLampsOfAPixel) {
    Halves halves = NoisyHalves(Grey(0.03), 0.001, 3);
    const auto set = [&](int x, float a, float b) {
        for (int c = 0; c < 3; ++c) halves.a.Row(c, 40)[x] = a, halves.b.Row(c, 40)[x] = b;
    };
    set(20, 12.3f, 11.2f);
    set(60, 3, 4);
    set(61, 9, 7);  // of the same lamp
    set(90, 0.4f, 0.6f);
    EXPECT_TRUE(TakeFireflies(8, &halves).empty());
}

TEST(Fireflies, KeepTheirColourAndShareItByBrightness) {
    Planes picture = Grey(0.1);
    for (int c = 0; c < 3; ++c)
        for (int x = 55; x < 65; ++x) picture.Row(c, 50)[x] = 0.8f;
    const Planes before = picture;
    GiveBack({{50 * 120 + 50, {40, 0, 0}}}, &picture);
    const float dark = picture.Row(0, 50)[45] - before.Row(0, 50)[45];
    const float bright = picture.Row(0, 50)[55] - before.Row(0, 50)[55];
    EXPECT_NEAR(bright / dark, 8, 0.8);
    for (size_t i = 0; i < picture.Area(); ++i) EXPECT_EQ(picture.Plane(1)[i], before.Plane(1)[i]);
}

// One event says nothing of how many there are: its light changes no pixel much, and all of it is
// doubt.
TEST(Fireflies, OfOneAreLimitedAndDoubted) {
    for (const float excess : {1e3f, 1e4f, 1e9f, 1e17f}) {
        Planes picture = Grey(0.3);
        const Planes deviation = GiveBack({{50 * 120 + 50, {excess, excess, excess}}}, &picture);
        for (const float v : picture.values) EXPECT_LE(v, 0.3f * 1.0501f) << excess;
        EXPECT_GT(deviation.Row(0, 50)[50], 0.2f) << excess;
        EXPECT_EQ(deviation.Row(0, 50)[119], 0);
        for (const float d : deviation.values) EXPECT_TRUE(d >= 0 && d <= 0.32f) << d;
    }
    // Of many, all is given back, with less doubt.
    std::vector<Firefly> many;
    for (size_t i = 0; i < 120 * 100; i += 7) many.push_back({i, {1, 1, 1}});
    Planes picture = Grey(0.3);
    const double before = SumOf(picture);
    const Planes deviation = GiveBack(many, &picture);
    EXPECT_NEAR((SumOf(picture) - before) / (3 * double(many.size())), 1, 1e-3);
    EXPECT_LT(deviation.Row(0, 50)[50], 0.02f);
}

}  // namespace
}  // namespace lull
