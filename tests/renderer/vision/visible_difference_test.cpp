#include "renderer/vision/visible_difference.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <random>
#include <thread>

#include "renderer/base/error.h"
#include "stopping/signals/lightness.h"
#include "tests/renderer/lab/example_images.h"

namespace lull::visible_test {
namespace {

// A square picture of linear RGB.
struct Picture {
    int side = 0;
    std::vector<float> values;
};

template <typename Value>
Picture MakePicture(int side, const Value& value) {
    Picture picture{side, {}};
    for (int y = 0; y < side; ++y)
        for (int x = 0; x < side; ++x)
            for (int c = 0; c < 3; ++c) picture.values.push_back(float(value(x, y, c)));
    return picture;
}

Picture Grey(int side, double level) {
    return MakePicture(side, [&](int, int, int) { return level; });
}

Picture Grating(int side, double level, double contrast, double frequency, double ppd) {
    return MakePicture(side, [&](int x, int, int) {
        return level * (1 + contrast * std::sin(2 * std::numbers::pi * frequency * x / ppd + 0.3));
    });
}

Picture AddNoise(Picture picture, double deviation, int fromX = 0, int toX = 1 << 20) {
    std::mt19937 random(1);
    std::normal_distribution<double> normal(0, deviation);
    for (size_t i = 0; i < picture.values.size(); i += 3) {
        const double noise = normal(random);
        const int x = int(i / 3) % picture.side;
        for (size_t c = i; c < i + 3; ++c)
            if (x >= fromX && x < toX) picture.values[c] += float(noise);
    }
    return picture;
}

VisibleDifference Find(const Picture& image, const Picture& reference,
                       const DisplayModel& display = {}) {
    return FindVisibleDifference(image.values, reference.values, image.side, image.side, display);
}

double Pooled(const Picture& image, const Picture& reference, const DisplayModel& display = {}) {
    return PooledDifference(Find(image, reference, display));
}

// A display in the dark that shows no more than what it is told.
DisplayModel DarkRoom(double peak, double ppd) {
    return {.peak = peak, .pixelsPerDegree = ppd, .ambient = 0, .contrast = 1e9};
}

TEST(VisibleDifference, IsZeroForTheSamePicture) {
    const Picture noisy = AddNoise(Grey(70, 0.5), 0.7);
    const VisibleDifference difference = Find(noisy, noisy);
    EXPECT_EQ(PooledDifference(difference), 0);
    for (const float v : VisibleMap(difference)) EXPECT_EQ(v, 0);
}

// The figure is that of another program (numpy) that was written from the same formulas.
TEST(VisibleDifference, HasAKnownValue) {
    const ExampleImages e;
    std::vector<float> image, reference;
    for (size_t i = 0; i < e.image.size(); ++i) {
        image.push_back(float(DecodeSrgb(e.image[i] / 255.0)));
        reference.push_back(float(DecodeSrgb(e.reference[i] / 255.0)));
    }
    const VisibleDifference difference =
        FindVisibleDifference(image, reference, kExampleWidth, kExampleHeight, {});
    EXPECT_NEAR(PooledDifference(difference), 11.37628, 1e-3);
}

// Contrast is 1 / sensitivity. Q grows with its power of 2.26, so that this range is one of 8 dB.
TEST(VisibleDifference, IsAboutOneForGratingsAtThreshold) {
    for (const double luminance : {5, 20, 50, 100})
        for (const double frequency : {1.0, 1.5, 2.0, 3.0, 4.0, 6.0, 8.0}) {
            const double threshold =
                1 / ContrastSensitivity(OpponentChannel::Achromatic,
                                        {frequency, 2.25 * std::numbers::pi, luminance});
            const DisplayModel display = DarkRoom(2 * luminance, 40);
            const double q =
                Pooled(Grating(256, 0.5, threshold, frequency, 40), Grey(256, 0.5), display);
            EXPECT_GT(q, 0.25) << frequency << " " << luminance;
            EXPECT_LT(q, 2.1) << frequency << " " << luminance;
        }
}

TEST(VisibleDifference, GrowsWithContrast) {
    for (const double frequency : {0.5, 2.0, 8.0, 16.0}) {
        double last = 0;
        for (double contrast = 0.001; contrast < 0.9; contrast *= 1.5) {
            const double q = Pooled(Grating(128, 0.5, contrast, frequency, 40), Grey(128, 0.5));
            EXPECT_GT(q, last) << frequency << " " << contrast;
            last = q;
        }
    }
}

TEST(VisibleDifference, GrowsWithThePowerOfContrastBelowMasking) {
    const auto at = [](double contrast) {
        return Pooled(Grating(128, 0.5, contrast, 4, 40), Grey(128, 0.5));
    };
    EXPECT_NEAR(at(0.008) / at(0.004), std::pow(2, 2.264), 0.05);
}

TEST(VisibleDifference, IsMaskedByTexture) {
    const Picture flat = Grey(128, 0.5);
    const Picture texture = AddNoise(flat, 0.1);
    const auto added = [&](Picture picture) {
        for (int y = 0; y < 128; ++y)
            for (int x = 0; x < 128; ++x)
                for (int c = 0; c < 3; ++c)
                    picture.values[size_t((y * 128 + x) * 3 + c)] +=
                        0.02f * float((x * 7 + y * 13) % 5 - 2);
        return picture;
    };
    EXPECT_LT(Pooled(added(texture), texture), 0.5 * Pooled(added(flat), flat));
}

TEST(VisibleDifference, FallsWithDistanceAndGrowsWithLuminance) {
    const Picture flat = Grey(128, 0.2), noisy = AddNoise(flat, 0.01);
    const double near = Pooled(noisy, flat, ParseDisplay("100cd,30ppd"));
    EXPECT_GT(near, Pooled(noisy, flat, ParseDisplay("100cd,60ppd")));
    EXPECT_LT(near, Pooled(noisy, flat, ParseDisplay("200cd,30ppd")));
    EXPECT_GT(near, Pooled(noisy, flat, ParseDisplay("100cd,30ppd,2000lux")));
}

TEST(VisibleDifference, SeesColour) {
    const Picture grey = Grey(128, 0.5);
    // As much less luminance of green as there is more of red.
    const Picture coloured = MakePicture(128, [](int x, int y, int c) {
        const double sign = (x / 16 + y / 16) % 2 ? 1 : -1;
        return 0.5 + sign * (c == 0 ? 0.05 : c == 1 ? -0.05 * 0.2126729 / 0.7151522 : 0);
    });
    EXPECT_GT(Pooled(coloured, grey), 1);
}

TEST(VisibleDifference, IsWhereThePicturesDiffer) {
    const Picture flat = Grey(256, 0.5), noisy = AddNoise(flat, 0.05, 0, 64);
    const VisibleDifference difference = Find(noisy, flat);
    const double noisyBlock = PooledDifference(difference, {{0, 0}, {64, 256}});
    EXPECT_GT(noisyBlock, 10 * PooledDifference(difference, {{192, 0}, {256, 256}}));
    EXPECT_GT(noisyBlock, PooledDifference(difference));
    const std::vector<float> map = VisibleMap(difference);
    ASSERT_EQ(map.size(), size_t(256 * 256));
    double noisyMean = 0, flatMean = 0;
    for (int y = 0; y < 256; ++y)
        for (int x = 0; x < 48; ++x) {
            noisyMean += double(map[size_t(y * 256 + x)]);
            flatMean += double(map[size_t(y * 256 + 255 - x)]);
        }
    EXPECT_GT(noisyMean, 100 * flatMean);
}

// Squares are averaged over places: parts of equal size make up the whole where one band counts.
TEST(Pool, AveragesItsParts) {
    const Picture flat = Grey(128, 0.5);
    const VisibleDifference difference = Find(Grating(128, 0.5, 0.05, 4, 40), flat);
    const double whole = PooledDifference(difference),
                 left = PooledDifference(difference, {{0, 0}, {64, 128}}),
                 right = PooledDifference(difference, {{64, 0}, {128, 128}});
    EXPECT_NEAR(whole, std::sqrt((left * left + right * right) / 2), 0.01 * whole);
}

TEST(VisibleDifference, IsFiniteForAllFloats) {
    constexpr float odd[] = {std::numeric_limits<float>::quiet_NaN(),
                             std::numeric_limits<float>::infinity(),
                             -std::numeric_limits<float>::infinity(),
                             -1,
                             std::numeric_limits<float>::max(),
                             std::numeric_limits<float>::denorm_min(),
                             0};
    Picture image = Grey(48, 0.5);
    const Picture reference = AddNoise(image, 0.2);
    for (size_t i = 0; i < image.values.size(); i += 5)
        image.values[i] = odd[i / 5 % std::size(odd)];
    for (const auto& [a, b] : {std::pair{image, reference}, {reference, image}, {image, image}}) {
        const VisibleDifference difference = Find(a, b);
        EXPECT_TRUE(std::isfinite(PooledDifference(difference)));
        for (const float v : VisibleMap(difference)) EXPECT_TRUE(std::isfinite(v) && v >= 0);
    }
    // Values beyond what the display shows do not differ.
    EXPECT_EQ(Pooled(Grey(48, 3), Grey(48, 1)), 0);
    EXPECT_EQ(Pooled(Grey(48, -3), Grey(48, 0)), 0);
}

TEST(VisibleDifference, TakesAnySize) {
    for (const auto& [width, height] :
         {std::pair{1, 1}, {1, 9}, {2, 2}, {7, 3}, {4, 300}, {33, 17}}) {
        const std::vector<float> a(size_t(width * height * 3), 0.5f),
            b(size_t(width * height * 3), 0.25f);
        const VisibleDifference difference = FindVisibleDifference(a, b, width, height, {});
        EXPECT_TRUE(std::isfinite(PooledDifference(difference)));
        EXPECT_EQ(VisibleMap(difference).size(), size_t(width * height));
        EXPECT_GE(PooledDifference(difference, {{width - 1, height - 1}, {width, height}}), 0);
    }
    EXPECT_THROW(FindVisibleDifference({}, {}, 0, 0, {}), Error);
    EXPECT_THROW(FindVisibleDifference(std::vector<float>(3), std::vector<float>(6), 1, 1, {}),
                 Error);
}

TEST(VisibleDifference, IsTheSameBitsOnAnyThread) {
    const Picture flat = Grey(100, 0.4), noisy = AddNoise(flat, 0.05);
    const VisibleDifference expected = Find(noisy, flat);
    std::vector<VisibleDifference> found(4);
    {
        std::vector<std::jthread> threads;
        for (VisibleDifference& difference : found)
            threads.emplace_back([&] { difference = Find(noisy, flat); });
    }
    for (const VisibleDifference& difference : found) {
        EXPECT_EQ(PooledDifference(difference), PooledDifference(expected));
        EXPECT_EQ(VisibleMap(difference), VisibleMap(expected));
    }
}

}  // namespace
}  // namespace lull::visible_test
