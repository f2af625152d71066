#include "renderer/denoise/denoiser.h"

#include <gtest/gtest.h>

#include "tests/renderer/denoise/example_pictures.h"

namespace lull {
namespace {

NoisyPicture NoisyExample() {
    return AddNoise(Planes(40, 30, 3, 0.5f), FlatFeatures(40, 30), 0.1, 1);
}

TEST(RunDenoiser, MeasuresThePictureThatItReturns) {
    const DenoisedPicture denoised = Denoise(NoisyExample());
    const PixelRect block{{5, 10}, {35, 30}};
    const DenoiserResult result = RunDenoiser(NoisyExample(), {&block, 1});
    EXPECT_EQ(result.rgb, Interleaved(denoised.picture));
    const EstimatedError error = MeasureError(denoised);
    EXPECT_EQ(result.deviation, StandardError(denoised, error.structure).values);
    const VisibleError expected = MeasureVisibleError(denoised, error, block);
    ASSERT_TRUE(result.blocks.at(0));
    EXPECT_GT(expected.upper, 0);
    EXPECT_EQ(result.blocks[0]->estimate, expected.estimate);
    EXPECT_EQ(result.blocks[0]->upper, expected.upper);
}

TEST(RunDenoiser, LeavesOutWhatIsTooSmallAndWhatNobodyAsksFor) {
    const PixelRect blocks[] = {{{0, 0}, {9, 30}}, {{0, 0}, {10, 10}}, {{0, 20}, {40, 29}}};
    const DenoiserResult result = RunDenoiser(NoisyExample(), blocks, {.withDeviation = false});
    EXPECT_TRUE(result.deviation.empty());
    ASSERT_EQ(result.blocks.size(), 3u);
    EXPECT_FALSE(result.blocks[0]);
    EXPECT_TRUE(result.blocks[1]);
    EXPECT_FALSE(result.blocks[2]);
}

TEST(RunDenoiser, IsQuickWhereAskedTo) {
    EXPECT_EQ(RunDenoiser(NoisyExample(), {}, {.isQuick = true}).rgb,
              Interleaved(Denoise(NoisyExample(), 2).picture));
}

}  // namespace
}  // namespace lull
