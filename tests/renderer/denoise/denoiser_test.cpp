#include "renderer/denoise/denoiser.h"

#include <gtest/gtest.h>

#include "tests/renderer/denoise/example_pictures.h"

namespace lull {
namespace {

NoisyPicture NoisyExample() {
    return AddNoise(Planes(40, 30, 3, 0.5f), FlatFeatures(40, 30), 0.1, 1);
}

TEST(RunDenoiser, LeavesOutWhatIsTooSmallAndWhatNobodyAsksFor) {
    const PixelRect blocks[] = {{{0, 0}, {9, 30}}, {{0, 0}, {10, 10}}, {{0, 20}, {40, 29}}};
    const DenoisedImage result = RunDenoiser(NoisyExample(), blocks, {.withDeviation = false});
    EXPECT_TRUE(result.error.empty());
    ASSERT_EQ(result.blocks.size(), 3u);
    EXPECT_FALSE(result.blocks[0]);
    EXPECT_TRUE(result.blocks[1]);
    EXPECT_FALSE(result.blocks[2]);
}

TEST(RunDenoiser, IsQuickWhereAskedTo) {
    EXPECT_EQ(RunDenoiser(NoisyExample(), {}, {.effort = Effort::Quick}).image.values,
              Interleaved(Denoise(NoisyExample(), Effort::Quick).picture));
}

// Two lamps of which each sample finds one: their noise cancels out in the sum.
GroupedPicture OppositeLamps(const Planes& features) {
    return {2, features, Planes(40, 30, 1, 1e-10f), [](int group) {
                NoisyPicture light{NoisyHalves(Planes(40, 30, 3, 0.5f), 0.1, 1), {}, {}, {}};
                for (Planes* half : {&light.colour.a, &light.colour.b})
                    for (float& v : half->values) v = group == 0 ? v : 1 - v;
                return light;
            }};
}

TEST(RunDenoiser, TellsTheShareThatIsDone) {
    const auto sharesOf = [](auto picture) {
        std::vector<double> shares;
        RunDenoiser(std::move(picture), {},
                    {.onShare = [&](double share) { shares.push_back(share); }});
        return shares;
    };
    for (const std::vector<double>& shares :
         {sharesOf(NoisyExample()),
          sharesOf(AddNoise(Planes(30, 300, 3, 0.5f), FlatFeatures(30, 300), 0.1, 1)),
          sharesOf(OppositeLamps(FlatFeatures(40, 30)))}) {
        ASSERT_FALSE(shares.empty());
        EXPECT_GT(shares.front(), 0);
        EXPECT_TRUE(std::ranges::is_sorted(shares));
        EXPECT_DOUBLE_EQ(shares.back(), 1);
    }
}

TEST(RunDenoiser, AddsUpGroupsAndTakesTheLargestError) {
    const PixelRect block{{0, 0}, {40, 30}};
    const Planes features = NoisyExample().features;
    const DenoisedImage result = RunDenoiser(OppositeLamps(features), {&block, 1});
    ASSERT_EQ(result.groups.size(), 2u);
    double largest = 0;
    for (int group = 0; group < 2; ++group) {
        NoisyPicture light = OppositeLamps(features).light(group);
        light.features = features;
        const DenoisedImage alone = RunDenoiser(std::move(light), {&block, 1});
        EXPECT_EQ(result.groups[size_t(group)], alone.image.values);
        largest = std::max(largest, alone.blocks.at(0)->upper);
    }
    for (size_t i = 0; i < result.image.values.size(); ++i)
        ASSERT_EQ(result.image.values[i], result.groups[0][i] + result.groups[1][i]);
    EXPECT_EQ(result.blocks.at(0)->upper, largest);
    // That of the sum alone is much smaller.
    NoisyPicture clean{{Planes(40, 30, 3, 1), Planes(40, 30, 3, 1)}, features, {}};
    EXPECT_LT(RunDenoiser(std::move(clean), {&block, 1}).blocks.at(0)->upper, 0.1 * largest);
}

// The picture can be noisy where no group is.
TEST(RunDenoiser, HeedsTheErrorOfTheSumOfGroups) {
    const PixelRect block{{0, 0}, {40, 30}};
    const GroupedPicture lamps{4, NoisyExample().features, {}, [](int) {
                                   const Planes dark(40, 30, 3, 0.1f);
                                   return NoisyPicture{NoisyHalves(dark, 0.02, 1), {}, {}, {}};
                               }};
    NoisyPicture one = lamps.light(0);
    one.features = lamps.features;
    const double ofOne = RunDenoiser(std::move(one), {&block, 1}).blocks.at(0)->upper;
    EXPECT_GT(RunDenoiser(lamps, {&block, 1}).blocks.at(0)->upper, ofOne);
}

// One pixel of one half, as other programs leave them: the picture keeps its look, and the error
// says that this may be wrong.
TEST(Denoiser, DoesNotCallAnExtremePixelClean) {
    const int width = 60, height = 50;
    const PixelRect block{{0, 0}, {width, height}};
    const NoisyPicture calm =
        AddNoise(Planes(width, height, 3, 0.3f), FlatFeatures(width, height), 0.02, 1);
    const double usual = RunDenoiser(calm, {&block, 1}).blocks[0]->upper;
    for (const float extreme : {1e4f, 1e6f}) {
        NoisyPicture picture = calm;
        for (int c = 0; c < 3; ++c) picture.colour.a.Row(c, 20)[30] = extreme;
        const DenoisedImage result = RunDenoiser(std::move(picture), {&block, 1});
        for (const float v : result.image.values) EXPECT_LT(v, 0.6f);
        EXPECT_GT(result.blocks[0]->upper, usual + 2) << extreme;
        EXPECT_GT(result.error[20 * width + 30], 5);
    }
}

TEST(Denoiser, TakesInfinityForBlack) {
    EXPECT_EQ(Sane(kInfinity), 0);
    EXPECT_EQ(Sane(1e30f), kLargest);
    EXPECT_EQ(Sane(-1), 0);
}

}  // namespace
}  // namespace lull
