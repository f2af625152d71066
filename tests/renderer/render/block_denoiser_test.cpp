// Blocks stop by the error of the denoised picture and, where their light is told apart, of that of
// each group.
#include "renderer/render/film_picture.h"

#include <gtest/gtest.h>

#include "stopping/rules/baselines.h"
#include "stopping/rules/rule_table.h"
#include "tests/renderer/render/synthetic_samples.h"

namespace lull::block_denoiser_test {
namespace {

const PixelRect kRegion = {{0, 0}, {40, 40}};

// Each sample finds one of two lamps: the light of each is noise, and their sum is grey.
void OneOfTwoLamps(Sampler& sampler, const Vec2i& pixel, uint32_t index, PathSample* sample) {
    sampler.StartSample(pixel, index);
    const int lamp = sampler.Get2D().x() < 0.5f ? 0 : 1;
    sample->index = index;
    sample->radiance = Rgb::Constant(0.5f);
    if (sample->groups) {
        sample->groups->Clear();
        sample->groups->Add(lamp, sample->radiance);
    }
    sample->features = {.albedo = sample->radiance, .depth = 1, .found = true};
}

// Renders by the rule `denoised`; returns the samples that the block took.
int SppOf(bool withGroups) {
    LayerOptions layers = {.features = true, .groupNoise = true};
    if (withGroups) layers.groups = {{"a", "b"}, {0, 1}};
    Film film(kRegion, {.grid = {.blockSize = 40, .tileSize = 8}, .layers = layers});
    RenderOptions options;
    options.sampler = Sampler(SamplerKind::Random, 0);
    options.schedule = {.blockSize = 40, .passLength = 20, .cap = 640};
    options.threads = 2;
    const auto denoiser = std::make_shared<BlockDenoiser>(MakeBlocks(kRegion, options.schedule));
    denoiser->Show(&film);
    options.makeCriterion = CriteriaOf(
        ParseRule("denoised:1", {.passSpp = 20,
                                 .blockCount = 1,
                                 .cap = 640,
                                 .measures = {{kDenoisedRuleName, MeasureOf(denoiser)}}}));
    const RenderResult result = Render(Onto(&film, options, OneOfTwoLamps));
    const auto* lights = film.layers.Find<LightGroupLayer>();
    for (int y = 0; y < 40 && withGroups; ++y)
        for (int x = 0; x < 40; ++x) {
            const FilmPixel a = lights->At(0, {x, y}, 1), b = lights->At(1, {x, y}, 1);
            EXPECT_EQ(a.sum[0] + b.sum[0], film.At({x, y}).sum[0]);
            EXPECT_EQ(a.halfSum[0] + b.halfSum[0], film.At({x, y}).halfSum[0]);
        }
    return result.blocks.at(0).block.spp;
}

TEST(BlockDenoiser, WaitsForEveryLightGroup) {
    EXPECT_EQ(SppOf(false), 20);
    EXPECT_GT(SppOf(true), 60);
}

}  // namespace
}  // namespace lull::block_denoiser_test
