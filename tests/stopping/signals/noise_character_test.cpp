#include "stopping/signals/noise_character.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <stdexcept>

#include "tests/stopping/signals/block_images.h"

namespace lull {
namespace {

NoiseCharacter Describe(const BlockImage& image, int subBlocks) {
    const BlockView view = image.At(20);
    return DescribeNoise(view, ComputeLightnessNoise(view), subBlocks, 0.05);
}

TEST(NoiseCharacter, CountsWhatIsWhite) {
    BlockImage image(40, 20, 0.5f);
    // Of the left half a quarter is white; one component alone makes no pixel white.
    for (size_t y = 0; y < 10; ++y)
        for (size_t x = 0; x < 10; ++x)
            for (size_t c = 0; c < 3; ++c) image.mean[3 * (40 * y + x) + c] = c == 0 ? 1.f : 2.f;
    image.mean[3 * (40 * 15 + 30)] = 5;
    const NoiseCharacter character = Describe(image, 4);
    EXPECT_FLOAT_EQ(character.saturated[0], 0.5f);
    for (size_t i = 1; i < 4; ++i) EXPECT_EQ(character.saturated[i], 0) << i;
}

TEST(NoiseCharacter, TellsGreyFromColouredNoise) {
    BlockImage grey(20, 20, 0.4f), coloured(20, 20, 0.4f);
    for (size_t i = 0; i < grey.halfMean.size(); ++i) {
        const float sign = i / 3 % 2 ? 1.f : -1.f;
        grey.halfMean[i] += 0.05f * sign;
        if (i % 3 == 2) coloured.halfMean[i] += 0.05f * sign;
    }
    EXPECT_LT(Describe(grey, 1).chromaNoise[0], 0.02f);
    // Blue of 0.45 and 0.35 instead of 0.4: b* differs by 200 (f(z) - f(z')), most of the noise.
    EXPECT_GT(Describe(coloured, 1).chromaNoise[0], 3);
}

TEST(NoiseCharacter, TellsBlotchesFromGrain) {
    BlockImage blotches(40, 40, 0.4f), grain(40, 40, 0.4f);
    for (size_t i = 0; i < blotches.halfMean.size(); ++i) {
        const size_t x = i / 3 % 40, y = i / 3 / 40;
        blotches.halfMean[i] += (x / 10 + y / 10) % 2 ? 0.05f : -0.05f;
        grain.halfMean[i] += (x + y) % 2 ? 0.05f : -0.05f;
    }
    EXPECT_GT(Describe(blotches, 1).correlation[0], 0.7f);
    EXPECT_NEAR(Describe(grain, 1).correlation[0], -1, 1e-5);
    EXPECT_NEAR(Describe(NoisyBlock(60, 60, 0.1, 20, 7), 1).correlation[0], 0, 0.06);
    EXPECT_EQ(Describe(BlockImage(20, 20, 0.4f), 1).correlation[0], 0);
}

TEST(NoiseCharacter, HasQuantilesOfWhatIsSeen) {
    BlockImage image(20, 20, 0.4f);
    for (size_t c = 0; c < 3; ++c) image.halfMean[3 * 37 + c] += 0.2f;  // one of 400 pixels
    const NoiseCharacter one = Describe(image, 1);
    for (const float q : one.quantiles) EXPECT_EQ(q, 0);
    const NoiseCharacter all = Describe(NoisyBlock(60, 60, 0.1, 20, 7), 1);
    for (size_t i = 1; i < all.quantiles.size(); ++i)
        EXPECT_GT(all.quantiles[i], all.quantiles[i - 1]);
}

TEST(NoiseCharacter, IsFiniteWhateverItIsShown) {
    BlockImage image(20, 20, 0.4f);
    const float inf = std::numeric_limits<float>::infinity();
    image.mean[5] = image.halfMean[80] = std::numeric_limits<float>::quiet_NaN();
    image.mean[9] = inf, image.halfMean[300] = -inf;
    const NoiseCharacter character = Describe(image, 4);
    for (const auto* values :
         {&character.saturated, &character.chromaNoise, &character.correlation})
        for (const float v : *values) EXPECT_TRUE(std::isfinite(v));
    for (const float v : character.quantiles) EXPECT_TRUE(std::isfinite(v));
    EXPECT_THROW(Describe(image, 3), std::invalid_argument);
    EXPECT_THROW(Describe(image, 441), std::invalid_argument);
}

}  // namespace
}  // namespace lull
