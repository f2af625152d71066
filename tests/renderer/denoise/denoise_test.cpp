#include "renderer/denoise/denoise.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <limits>

#include "tests/renderer/denoise/example_pictures.h"

namespace lull {
namespace {

void ExpectSane(const DenoisedPicture& result) {
    for (const float v : result.picture.values) {
        ASSERT_TRUE(std::isfinite(v));
        ASSERT_GE(v, 0);
    }
}

TEST(Denoise, LeavesLittleOfPureNoise) {
    const Planes truth(160, 130, 3, 0.4f);
    const NoisyPicture noisy = AddNoise(truth, FlatFeatures(160, 130), 0.1, 1);
    const DenoisedPicture result = Denoise(noisy);
    ExpectSane(result);
    EXPECT_LT(Rms(result.picture, truth), Rms(MeanOf(noisy.colour), truth) / 14);
    EXPECT_NEAR(SumOf(result.picture) / SumOf(MeanOf(noisy.colour)), 1, 2e-3);
}

TEST(Denoise, KeepsTextureThatFeaturesKnow) {
    Planes features = FlatFeatures(160, 130);
    std::mt19937 generator(2);
    std::uniform_real_distribution<float> uniform(0.2f, 0.8f);
    for (size_t i = 0; i < features.Area(); ++i)
        for (int c = 0; c < 3; ++c)
            features.Plane(c)[i] = c == 0 ? uniform(generator) : features.Plane(0)[i];
    const Planes truth = MakePlanes(
        160, 130, 3, [&](int, int x, int y) { return features.Row(0, y)[x] * (0.3 + 0.002 * x); });
    const NoisyPicture noisy = AddNoise(truth, features, 0.1, 3);
    EXPECT_LT(Rms(Denoise(noisy).picture, truth), Rms(MeanOf(noisy.colour), truth) / 5);
}

// Texture of which features know nothing, as strong as the noise: it has to come back as the noise
// falls, and never may it be worse than the samples by more than a little.
TEST(Denoise, GoesToTheMeanOfTheSamples) {
    std::mt19937 generator(4);
    std::normal_distribution<double> gauss(0.5, 0.05);
    const Planes truth = MakePlanes(160, 130, 3, [&](int, int, int) { return gauss(generator); });
    double before = 1;
    for (const double noise : {0.07, 0.02, 0.005, 0.001}) {
        const NoisyPicture noisy = AddNoise(truth, FlatFeatures(160, 130), noise, 5);
        const double error = Rms(Denoise(noisy).picture, truth);
        EXPECT_LT(error, 1.25 * Rms(MeanOf(noisy.colour), truth)) << noise;
        EXPECT_LT(error, before);
        before = error;
    }
}

TEST(Denoise, KeepsLinesOfOnePixel) {
    const Planes truth = MakePlanes(
        160, 130, 3, [](int, int x, int y) { return (x + 2 * y) % 40 == 0 ? 0.8 : 0.3; });
    const NoisyPicture noisy = AddNoise(truth, FlatFeatures(160, 130), 0.04, 6);
    const Planes picture = Denoise(noisy).picture;
    double line = 0;
    int count = 0;
    for (int y = 0; y < 130; ++y)
        for (int x = 0; x < 160; ++x)
            if ((x + 2 * y) % 40 == 0) line += double(picture.Row(1, y)[x]), ++count;
    EXPECT_NEAR(line / count, 0.8, 0.03);
    EXPECT_LT(Rms(picture, truth), Rms(MeanOf(noisy.colour), truth));
}

TEST(Denoise, DoesNotChangeWhatHasNoNoise) {
    const Planes gradient =
        MakePlanes(140, 60, 3, [](int c, int x, int) { return 0.01 * c + 0.004 * x; });
    const Planes black(140, 60, 3, 0), white(140, 60, 3, 1), bright(140, 60, 3, 1e6f);
    for (const Planes& truth : {gradient, black, white, bright}) {
        const NoisyPicture noisy = AddNoise(truth, FlatFeatures(140, 60), 0, 7);
        const Planes picture = Denoise(noisy).picture;
        for (size_t i = 0; i < picture.values.size(); ++i)
            ASSERT_NEAR(picture.values[i], truth.values[i], 1e-4f * truth.values[i] + 1e-4f);
    }
}

// The mean of 20 x 20 pixels stays within what the noise of the samples leaves of it.
TEST(Denoise, KeepsTheEnergyOfPatches) {
    const Planes truth = MakePlanes(160, 120, 3, [](int, int x, int y) {
        return 0.3 + 0.2 * std::sin(x * 0.1) * std::cos(y * 0.07);
    });
    NoisyPicture noisy = AddNoise(truth, FlatFeatures(160, 120), 0.05, 8);
    for (int c = 0; c < 3; ++c) noisy.colour.b.Row(c, 63)[71] = 40;  // a firefly
    const Planes picture = Denoise(noisy).picture, mean = MeanOf(noisy.colour);
    for (int v = 0; v < 120; v += 20)
        for (int u = 0; u < 160; u += 20) {
            double difference = 0;
            for (int y = v; y < v + 20; ++y)
                for (int x = u; x < u + 20; ++x)
                    difference += double(picture.Row(1, y)[x]) - double(mean.Row(1, y)[x]);
            // 0.05 / sqrt 2 a pixel of the mean; the firefly's patch has 20 / 400 more.
            const bool hasFirefly = v == 60 && u == 60;
            EXPECT_LT(std::abs(difference / 400), hasFirefly ? 0.06 : 0.012) << u << " " << v;
        }
    EXPECT_NEAR(SumOf(picture) / SumOf(mean), 1, 2e-3);
}

TEST(Denoise, LeavesNoBlobsOfFireflies) {
    const Planes truth(120, 120, 3, 0.3f);
    NoisyPicture noisy = AddNoise(truth, FlatFeatures(120, 120), 0.05, 9);
    for (int c = 0; c < 3; ++c) noisy.colour.a.Row(c, 60)[60] = 1000;
    EXPECT_LT(std::ranges::max(Denoise(noisy).picture.values), 0.33f);
}

// Pixels around one that is bright in both halves are as clean as all others.
TEST(Denoise, CleansAroundGlints) {
    const Planes truth(120, 120, 3, 0.3f);
    NoisyPicture noisy = AddNoise(truth, FlatFeatures(120, 120), 0.05, 9);
    noisy.variance = Planes(120, 120, 1, 0.05f * 0.05f / 2);
    for (int c = 0; c < 3; ++c)
        noisy.colour.a.Row(c, 60)[60] = 10, noisy.colour.b.Row(c, 60)[60] = 11;
    const Planes picture = Denoise(noisy).picture;
    for (int y = 54; y < 67; ++y)
        for (int x = 54; x < 67; ++x) {
            if (x == 60 && y == 60) continue;
            EXPECT_NEAR(picture.Row(1, y)[x], 0.3f, 0.02f);
        }
    EXPECT_NEAR(picture.Row(1, 60)[60], 10.5f, 0.3f);
}

TEST(Denoise, TakesWhateverItIsGiven) {
    const float inf = std::numeric_limits<float>::infinity(), nan = std::nanf("");
    NoisyPicture noisy = AddNoise(Planes(60, 50, 3, 0.4f), FlatFeatures(60, 50), 0.1, 10);
    noisy.variance = Planes(60, 50, 1, 0.01f);
    Halves features{FlatFeatures(60, 50), FlatFeatures(60, 50)};
    size_t i = 17;
    for (const float value : {nan, inf, -inf, -3.f, 1e38f, 1e-40f})
        for (Planes* planes :
             {&noisy.colour.a, &noisy.colour.b, &features.a, &features.b, &noisy.variance})
            planes->values[(i += 131) % planes->values.size()] = value;
    noisy.features = Filtered(features);
    ExpectSane(Denoise(noisy));
}

TEST(Denoise, TakesPicturesOfAnySize) {
    for (const auto& [width, height] :
         {std::pair(1, 1), {2, 1}, {1, 40}, {17, 3}, {129, 2}, {2, 301}}) {
        const NoisyPicture noisy =
            AddNoise(Planes(width, height, 3, 0.4f), FlatFeatures(width, height), 0.01, 11);
        const DenoisedPicture result = Denoise(noisy);
        ExpectSane(result);
        EXPECT_LT(Rms(result.picture, Planes(width, height, 3, 0.4f)), 0.02);
    }
}

// Stripes and noise, of more rows than are worked on at once.
NoisyPicture TallPicture() {
    const Planes truth =
        MakePlanes(150, 300, 3, [](int, int x, int y) { return (x / 7 + y / 5) % 3 * 0.2 + 0.1; });
    return AddNoise(truth, FlatFeatures(150, 300), 0.1, 12);
}

TEST(Denoise, IsTheSameOnAnyNumberOfThreads) {
    const NoisyPicture noisy = TallPicture();
    const auto on = [&](size_t threads) {
        const tbb::global_control control(tbb::global_control::max_allowed_parallelism, threads);
        return Denoise(noisy).picture.values;
    };
    EXPECT_EQ(on(1), on(4));
}

// The upper rows by themselves are few enough to be worked on at once.
TEST(Denoise, LeavesNoTraceOfBands) {
    const NoisyPicture noisy = TallPicture();
    const ImageTile upper{0, 0, 150, 256}, seen{0, 0, 150, 160};
    const NoisyPicture part{{Crop(noisy.colour.a, upper), Crop(noisy.colour.b, upper)},
                            Crop(noisy.features, upper),
                            {}};
    const Planes whole = Crop(Denoise(noisy).picture, seen);
    EXPECT_LT(Rms(whole, Crop(Denoise(part).picture, seen)), 1e-6);
}

// Lamps of a pixel on a smooth ceiling, each met by some of the samples of a half.
TEST(Denoise, KeepsSmallLampsAsTheyAre) {
    const NoisyPicture rest =
        AddNoise(MakePlanes(160, 128, 3, [](int, int x, int) { return 0.05 + 0.0002 * x; }),
                 FlatFeatures(160, 128), 0.003, 23);
    NoisyPicture whole = rest;
    const Planes dark(160, 128, 3);
    whole.emission = {dark, dark};
    std::mt19937 generator(22);
    std::binomial_distribution<int> met(32, 0.2);
    for (int y = 8; y < 128; y += 16)
        for (int x = 8; x < 160; x += 16)
            for (const auto half : {&Halves::a, &Halves::b}) {
                const float value = float(met(generator));
                for (int c = 0; c < 3; ++c) {
                    (whole.emission.*half).Row(c, y)[x] = value;
                    (whole.colour.*half).Row(c, y)[x] += value;
                }
            }
    const DenoisedPicture alone = Denoise(rest), result = Denoise(whole);
    const Planes lamps = MeanOf(whole.emission);
    for (size_t i = 0; i < lamps.values.size(); ++i) {
        ASSERT_NEAR(result.picture.values[i], alone.picture.values[i] + lamps.values[i], 1e-5f);
        ASSERT_GE(result.variance.values[i], alone.variance.values[i] * 0.999f);
    }
    // Their noise is part of the error.
    double noise = 0;
    for (int y = 8; y < 128; y += 16)
        for (int x = 8; x < 160; x += 16) noise += double(result.variance.Row(1, y)[x]) / 80;
    EXPECT_NEAR(noise, 32 * 0.2 * 0.8 / 9, 0.3);
}

// Edges of large ones are filtered like all edges.
TEST(Denoise, FiltersLargeLamps) {
    NoisyPicture noisy = AddNoise(Planes(160, 128, 3, 0.5f), FlatFeatures(160, 128), 0.05, 24);
    const Planes before = MeanOf(noisy.colour), truth(160, 128, 3, 0.5f);
    noisy.emission = noisy.colour;
    EXPECT_LT(Rms(Denoise(noisy).picture, truth), Rms(before, truth) / 5);
}

TEST(Scales, HalvesByMeans) {
    const Planes image =
        MakePlanes(5, 3, 2, [](int c, int x, int y) { return 100 * c + 10 * y + x; });
    const Planes half = Halved(image);
    ASSERT_EQ(half.width, 3);
    ASSERT_EQ(half.height, 2);
    EXPECT_FLOAT_EQ(half.Row(0, 0)[0], 5.5f);
    EXPECT_FLOAT_EQ(half.Row(0, 0)[2], 9.f);  // a column alone
    EXPECT_FLOAT_EQ(half.Row(1, 1)[1], 122.5f);
    EXPECT_FLOAT_EQ(half.Row(1, 1)[2], 124.f);
}

TEST(Scales, ReplaceNothingByItself) {
    const Planes image =
        MakePlanes(21, 34, 3, [](int c, int x, int y) { return c + x * 7 % 5 + y * 3 % 11; });
    EXPECT_EQ(WithCoarsePart(image, Halved(image)).values, image.values);
}

// What is wider than two pixels comes from the coarse picture, what is finer stays.
TEST(Scales, ReplaceTheCoarsePart) {
    const auto fine = [](int x, int y) { return (x + y) % 2 * 0.1; };
    const auto wide = [](int x, int y) { return 0.01 * x + 0.02 * y; };
    const auto wrong = [](int x) { return std::sin(x * 0.05); };
    const Planes truth =
        MakePlanes(64, 48, 3, [&](int, int x, int y) { return fine(x, y) + wide(x, y); });
    const Planes off = MakePlanes(
        64, 48, 3, [&](int, int x, int y) { return fine(x, y) + wide(x, y) + wrong(x); });
    EXPECT_GT(Rms(off, truth, 4), 0.3);
    EXPECT_LT(Rms(WithCoarsePart(off, Halved(truth)), truth, 4), 0.002);
}

TEST(Scales, TakePicturesOfAnySize) {
    for (const auto& [width, height] : {std::pair(1, 1), {2, 1}, {1, 3}, {3, 3}}) {
        const Planes image(width, height, 3, 0.5f);
        EXPECT_EQ(WithCoarsePart(Planes(width, height, 3), Halved(image)).values, image.values);
    }
}

TEST(Doubled, KeepsWhatIsSmooth) {
    const Planes image = MakePlanes(31, 17, 2, [](int c, int x, int y) { return c + x + 2 * y; });
    const Planes doubled = Doubled(Halved(image), 31, 17);
    for (int c = 0; c < 2; ++c)
        for (int y = 2; y < 14; ++y)
            for (int x = 2; x < 28; ++x)
                EXPECT_NEAR(doubled.Row(c, y)[x], image.Row(c, y)[x], 1e-4f);
}

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
    EXPECT_LT(std::ranges::max(picture.values), 0.32f);
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
