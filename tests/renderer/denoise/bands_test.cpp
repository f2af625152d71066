// Large pictures are worked on in tiles and bands of rows: a part has the same bits as alone.
#include <gtest/gtest.h>

#include "renderer/denoise/denoiser.h"
#include "tests/renderer/denoise/example_pictures.h"

namespace lull::bands_test {
namespace {

constexpr int kWidth = 260, kHeight = 440;  // three tiles a row, four bands

// Stripes with noise, fireflies and an edge that features do not show.
Halves Large(int width = kWidth, int height = kHeight) {
    const Planes truth = MakePlanes(width, height, 3, [](int c, int x, int y) {
        return (x / 7 + y / 5) % 3 * 0.2 + 0.1 * c + (x > 2 * y - 300 ? 0.5 : 0);
    });
    Halves noisy = NoisyHalves(truth, 0.1, 31);
    for (size_t i = 100; i + 2 < truth.Area(); i += 2567)
        noisy.a.Plane(1)[i] = noisy.b.Plane(0)[i + 2] = 200;
    return noisy;
}

// A part that is one tile, and the middle of it, whose margins are within the part.
const ImageTile kPart{100, 180, 228, 420};
ImageTile Middle(int margin) { return kPart.Grown(-margin); }

TEST(Bands, AreNotSeenInVariances) {
    const Halves noisy = Large();
    const Planes ofMean(kWidth, kHeight, 1, 0.005f);
    const ImageTile middle = Middle(11);
    const Planes whole = EstimateVariance(noisy, ofMean);
    const Planes part = EstimateVariance(Crop(noisy, kPart), Crop(ofMean, kPart));
    EXPECT_EQ(Crop(whole, middle).values, Crop(part, middle.In(kPart)).values);
}

TEST(Bands, AreNotSeenInFireflies) {
    Halves whole = Large(), part = Crop(whole, kPart);
    const std::vector<Firefly> all = TakeFireflies(4, &whole), some = TakeFireflies(4, &part);
    EXPECT_GT(some.size(), 5u);
    const ImageTile middle = Middle(8);
    EXPECT_EQ(Crop(whole.a, middle).values, Crop(part.a, middle.In(kPart)).values);
    EXPECT_EQ(Crop(whole.b, middle).values, Crop(part.b, middle.In(kPart)).values);

    Planes picture = whole.a, upper = Crop(whole.a, {0, 0, kWidth, 420});
    const Planes ofWhole = GiveBack(all, &picture);
    std::vector<Firefly> above;
    for (const Firefly& f : all)
        if (f.pixel < size_t(kWidth) * 420) above.push_back(f);
    const Planes ofUpper = GiveBack(above, &upper);
    const ImageTile seen{0, 0, kWidth, 340};
    EXPECT_EQ(Crop(picture, seen).values, Crop(upper, seen).values);
    EXPECT_EQ(Crop(ofWhole, seen).values, Crop(ofUpper, seen).values);
    EXPECT_NE(Crop(picture, seen).values, Crop(whole.a, seen).values);
}

TEST(Bands, AreNotSeenInRestoredStructure) {
    const Halves noisy = Large();
    const Planes grey(kWidth, kHeight, 3, 0.3f), variance(kWidth, kHeight, 3, 0.01f);
    Halves whole{grey, grey}, part{Crop(grey, kPart), Crop(grey, kPart)};
    RestoreStructure(noisy, variance, &whole);
    RestoreStructure(Crop(noisy, kPart), Crop(variance, kPart), &part);
    const ImageTile middle = Middle(3 * (kStructureReach + 2));
    EXPECT_EQ(Crop(whole.a, middle).values, Crop(part.a, middle.In(kPart)).values);
    EXPECT_NE(Crop(whole.a, middle).values, Crop(grey, middle).values);
}

// Both as it is and as it is shown.
TEST(Bands, AreNotSeenInErrors) {
    constexpr int kNarrow = 24, kTall = 262;  // rows for two bands
    const Planes features = FlatFeatures(kNarrow, kTall);
    const NoisyPicture tall{Large(kNarrow, kTall), Filtered({features, features}),
                            Planes(kNarrow, kTall, 1, 0.005f)};
    const DenoisedPicture denoised = Denoise(tall);
    const Grading dark = [](std::span<float> rgb) {
        for (float& v : rgb) v *= 0.3f;
    };
    const PixelRect blocks[] = {{{0, 0}, {16, 100}}, {{4, 120}, {24, 260}}};
    for (const Grading& grading : {Grading(), dark}) {
        const DenoisedImage result = RunDenoiser(tall, blocks, {.gradings = {grading}});
        EXPECT_EQ(result.image.values, Interleaved(denoised.picture));
        const DenoisedPicture shown = Graded(denoised, grading);
        const EstimatedError error = MeasureError(shown);
        EXPECT_TRUE(std::ranges::equal(result.error, StandardError(shown, error.structure).values));
        for (size_t i = 0; i < 2; ++i) {
            const VisibleError expected = MeasureVisibleError(shown, error, blocks[i]);
            EXPECT_EQ(result.blocks.at(i)->estimate, expected.estimate);
            EXPECT_EQ(result.blocks.at(i)->upper, expected.upper);
        }
    }
}

// Features of which the median is not that of the first rows.
TEST(Bands, AreForgottenWhenTheyAreFiltered) {
    const Planes features = MakePlanes(40, 300, kFeatures, [](int c, int x, int y) {
        return c == 6 ? 1 + (y * 40 + x) % 977 : 0.001 * ((x * 31 + y * 17) % 100);
    });
    const auto rows = [&](int y0, int y1) {
        const ImageTile tile{0, y0, 40, y1};
        return Halves{Crop(features, tile), Crop(features, tile)};
    };
    int least = 0;
    const auto read = [&](int y0, int y1) {
        EXPECT_TRUE(y0 >= least);
        return rows(y0, y1);
    };
    const Planes filtered =
        FilterFeatures(40, 300, read, [&](int end) { least = std::max(least, end); });
    EXPECT_GT(least, 250);
    EXPECT_EQ(filtered.values, FilterFeatures(40, 300, rows).values);
    // The first value is 1. No noise: nothing but the scale is changed.
    std::vector<float> depths;
    for (const float* d = features.Plane(6); d != features.Plane(6) + features.Area(); ++d)
        depths.insert(depths.end(), 2, *d);
    std::ranges::sort(depths);
    const float median = depths[depths.size() / 2];
    EXPECT_FLOAT_EQ(filtered.Plane(6)[0], 1 / (1 + median));
}

}  // namespace
}  // namespace lull::bands_test
