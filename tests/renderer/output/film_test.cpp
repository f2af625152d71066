#include "renderer/output/film.h"

#include <gtest/gtest.h>

namespace lull {
namespace {

TEST(InHalf, SplitsEveryMultipleOfFourSamplesEvenly) {
    uint32_t inHalf = 0;
    for (uint32_t n = 0; n <= 10000; ++n) {
        if (n % 4 == 0) {
            ASSERT_EQ(inHalf, n / 2) << n;
        }
        inHalf += InHalf(n);
    }
}

TEST(InHalf, FollowsTheParityOfTheOddBits) {
    const bool expected[] = {0, 0, 1, 1, 0, 0, 1, 1, 1, 1, 0, 0, 1, 1, 0, 0};
    for (uint32_t k = 0; k < 16; ++k) EXPECT_EQ(InHalf(k), expected[k]) << k;
    EXPECT_TRUE(InHalf(0x80000000u));
    EXPECT_FALSE(InHalf(0x40000000u));
}

TEST(HalfCount, CountsAnyNumberOfSamples) {
    uint32_t inHalf = 0;
    for (uint32_t n = 0; n <= 5000; ++n) {
        ASSERT_EQ(HalfCount(n), inHalf) << n;
        inHalf += InHalf(n);
    }
}

TEST(FilmPixel, KeepsSumsOfAllAndOfTheHalf) {
    FilmPixel pixel;
    Rgb all(0, 0, 0), half(0, 0, 0);
    for (uint32_t k = 0; k < 20; ++k) {
        const Rgb radiance(float(k), float(2 * k), 1);
        pixel.Add(radiance, k == 7);
        all += radiance;
        if (InHalf(k)) half += radiance;
    }
    EXPECT_EQ(pixel.count, 20u);
    EXPECT_EQ(pixel.rejected, 1u);
    EXPECT_TRUE((pixel.Mean() == all / 20).all());
    EXPECT_TRUE((pixel.HalfMean() == half / 10).all());
}

TEST(FilmPixel, HasMeansFromTheFirstSampleOn) {
    FilmPixel pixel;
    EXPECT_TRUE(IsBlack(pixel.Mean()));
    EXPECT_TRUE(IsBlack(pixel.HalfMean()));
    pixel.Add(Rgb(1, 2, 3), false);
    EXPECT_TRUE((pixel.Mean() == Rgb(1, 2, 3)).all());
    EXPECT_TRUE((pixel.HalfMean() == Rgb(1, 2, 3)).all());
}

// A float sum would have stopped growing at 2^24.
TEST(FilmPixel, LosesNothingOverManySamples) {
    FilmPixel pixel;
    pixel.sum = {0x1p24, 0x1p24, 0x1p24};
    pixel.Add(Rgb(1, 1, 1), false);
    EXPECT_EQ(pixel.sum[0], 0x1p24 + 1);
}

TEST(Film, AddressesPixelsOfTheFullImage) {
    Film film({{10, 20}, {14, 23}});
    for (int y = 20; y < 23; ++y)
        for (int x = 10; x < 14; ++x) film.At({x, y}).Add(Rgb(float(x), float(y), 0), false);
    const std::vector<float> mean = film.MeanImage();
    ASSERT_EQ(mean.size(), 4u * 3u * 3u);
    EXPECT_EQ(mean[0], 10);
    EXPECT_EQ(mean[1], 20);
    EXPECT_EQ(mean[3 * 5], 11);  // the second pixel of the second row
    EXPECT_EQ(mean[3 * 5 + 1], 21);
    EXPECT_EQ(film.SampleCount(), 12);
    EXPECT_EQ(film.SppImage(), std::vector<float>(12, 1));
}

TEST(Film, ExtractsRectanglesIntoBuffersOfAnyFormerSize) {
    Film film({{0, 0}, {5, 4}});
    for (int y = 0; y < 4; ++y)
        for (int x = 0; x < 5; ++x)
            for (int k = 0; k < 4; ++k)
                film.At({x, y}).Add(Rgb(float(x), float(y), InHalf(k) ? 2.f : 0.f), false);
    FilmView view;
    film.Extract({{0, 0}, {5, 4}}, true, &view);
    film.Extract({{2, 1}, {4, 3}}, true, &view);
    EXPECT_EQ(view.width, 2);
    EXPECT_EQ(view.height, 2);
    EXPECT_EQ(view.mean, (std::vector<float>{2, 1, 1, 3, 1, 1, 2, 2, 1, 3, 2, 1}));
    EXPECT_EQ(view.halfMean, (std::vector<float>{2, 1, 2, 3, 1, 2, 2, 2, 2, 3, 2, 2}));
    film.Extract({{2, 1}, {4, 3}}, false, &view);
    EXPECT_TRUE(view.halfMean.empty());
}

TEST(Film, CountsRejectedSamples) {
    Film film({{0, 0}, {2, 1}});
    film.At({0, 0}).Add(Rgb(0, 0, 0), true);
    film.At({1, 0}).Add(Rgb(0, 0, 0), true);
    film.At({1, 0}).Add(Rgb(1, 1, 1), false);
    EXPECT_EQ(film.RejectedCount(), 2);
}

}  // namespace
}  // namespace lull
