#include "renderer/scene/lights/environment_tiles.h"

#include <gtest/gtest.h>

#include <numeric>

#include "tests/renderer/bsdf/sphere_statistics.h"

namespace lull::environment_tiles_test {
namespace {

using test::ChiSquarePValue;
using test::Random;

constexpr int kTiles = TileShares::kCount;

// Weights of many magnitudes, some of them 0, a band of them, too.
std::vector<float> UnevenWeights() {
    std::vector<float> weights(kTiles);
    for (int i = 0; i < kTiles; ++i)
        if (i % 7 && i / TileShares::kColumns != 3)
            weights[size_t(i)] = std::exp(float(i % 23) - 11);
    return weights;
}

TEST(TileShares, AreProbabilitiesThatFollowTheWeights) {
    const std::vector<float> weights = UnevenWeights();
    const double total = std::accumulate(weights.begin(), weights.end(), 0.);
    const TileShares shares{weights};
    EXPECT_TRUE(IsValid(shares));
    double sum = 0;
    for (int i = 0; i < kTiles; ++i) {
        const float p = shares.Probability(i);
        EXPECT_EQ(p > 0, weights[size_t(i)] > 0) << i;
        EXPECT_NEAR(p, double(weights[size_t(i)]) / total, 1e-4) << i;
        sum += double(p);
    }
    EXPECT_NEAR(sum, 1, 1e-6);

    TileShares damaged = shares;
    std::swap(damaged.bands[2], damaged.bands[6]);
    EXPECT_FALSE(IsValid(damaged));
    EXPECT_FALSE(IsValid(TileShares()));
}

TEST(TileShares, ChooseAsTheProbabilitiesSay) {
    const TileShares shares{UnevenWeights()};
    std::vector<double> expected;
    for (int i = 0; i < kTiles; ++i) expected.push_back(double(shares.Probability(i)));
    constexpr int kSamples = 400000;
    std::vector<int64_t> chosen(kTiles);
    Random random(3);
    double mean = 0;
    for (int k = 0; k < kSamples; ++k) {
        Vec2f u = random.Point();
        ++chosen[size_t(shares.Choose(&u))];
        ASSERT_TRUE(u.minCoeff() >= 0 && u.maxCoeff() < 1);
        mean += double(u.x() + u.y()) / (2 * kSamples);
    }
    EXPECT_GT(ChiSquarePValue(expected, chosen, kSamples), 1e-3);
    EXPECT_NEAR(mean, 0.5, 0.002);  // what is left of u is even
}

TEST(TileShares, HaveATileWhereNothingWeighsAnything) {
    const TileShares shares{std::vector<float>(kTiles)};
    EXPECT_TRUE(IsValid(shares));
    Vec2f u(0.7f, 0.9f);
    EXPECT_EQ(shares.Choose(&u), 0);
    EXPECT_EQ(shares.Probability(0), 1);
}

// Makes a sky that gets brighter towards one side, with a sun of one cell where `sun` is positive.
BlockDistribution Sky(int width, int height, float sun) {
    const auto weigh = [=](int y, std::span<float> weights) {
        for (int x = 0; x < width; ++x)
            weights[x] =
                std::sin(kPi * (y + 0.5f) / height) * (1 + 0.5f * std::cos(2 * kPi * x / width)) +
                (y == height / 3 && x == width / 4 ? sun : 0);
    };
    return {width, height, weigh, 0.01f};
}

// Draws samples by tile, and compares them with the density, and with sampling without tiles.
TEST(EnvironmentTiles, SamplesHaveTheDensityAndLieInTheirTile) {
    struct Size {
        int width, height;
        float sun;
    };
    for (const auto& [width, height, sun] :
         {Size{1024, 512, 1e5f}, Size{12, 8, 50}, Size{1, 1, 0}, Size{601, 337, 3}}) {
        const BlockDistribution map = Sky(width, height, sun);
        const EnvironmentTiles tiles(map);
        Random random(5);
        double inverse = 0;
        constexpr int kSamples = 100000;
        for (int k = 0; k < kSamples; ++k) {
            Vec2f u = random.Point();
            const int tile = tiles.Shares().Choose(&u);
            float pdf;
            const Vec2f st = tiles.Sample(tile, u, &pdf);
            ASSERT_TRUE(st.minCoeff() >= 0 && st.maxCoeff() < 1 && pdf > 0);
            const float share = tiles.Shares().Probability(tile);
            inverse += 1 / (double(pdf) * double(share) * kSamples);
            // Away from borders, where rounding may have its way, both agree.
            const Vec2f cell = st.cwiseProduct(Vec2f(width, height));
            const Vec2f inCell = cell.array() - cell.array().floor();
            if (inCell.minCoeff() < 0.01f || inCell.maxCoeff() > 0.99f) continue;
            int found;
            ASSERT_NEAR(tiles.Pdf(st, &found), pdf, 1e-4 * pdf);
            ASSERT_EQ(found, tile);
            ASSERT_NEAR(map.Pdf(st), pdf * share, 0.05 * pdf * share);  // 16 bits
        }
        // The mean of 1 / density is the area that there is light from: all of it.
        EXPECT_NEAR(inverse, 1, 0.05) << width;
    }
}

TEST(EnvironmentTiles, GiveASunATileOfItsOwn) {
    const BlockDistribution map = Sky(1024, 512, 1e6f);
    const EnvironmentTiles tiles(map);
    const Vec2f sun((256 + 0.5f) / 1024, (170 + 0.5f) / 512);
    int tile, other;
    tiles.Pdf(sun, &tile);
    for (const Vec2f& by : {Vec2f(0.02f, 0), Vec2f(-0.02f, 0), Vec2f(0, 0.04f), Vec2f(0, -0.04f)}) {
        tiles.Pdf(sun + by, &other);
        EXPECT_NE(tile, other) << by.transpose();
    }
}

}  // namespace
}  // namespace lull::environment_tiles_test
