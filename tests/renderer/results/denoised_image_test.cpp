#include <fmt/format.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "renderer/base/error.h"
#include "renderer/denoise/visible_error.h"
#include "renderer/render/film_picture.h"
#include "renderer/results/denoised_image.h"
#include "renderer/results/report.h"
#include "stopping/rules/baselines.h"
#include "stopping/rules/rule_table.h"
#include "tests/renderer/render/synthetic_samples.h"

namespace lull {
namespace {

// The rule's default stands in its table as text.
TEST(DenoisedImage, IsAcceptedWhereTheRuleStops) {
    RuleContext context;
    context.measures[kDenoisedRuleName] = [](const BlockView&, const BlockInfo&) -> Signals {
        return 0.0;
    };
    EXPECT_EQ(ParseRule(kDenoisedRuleName, context).threshold, kAcceptedDifference);
}

TEST(DenoisedImage, NamesTheWorstPixels) {
    using Errors = std::vector<std::optional<VisibleError>>;
    const VisibleError clean{.estimate = 1, .upper = 2}, one{1, 2, 1, 7.4}, some{1, 2.5, 2, 20.6};
    const std::string most =
        "visible difference from the true image at most about 1 in half of the blocks and 1 in "
        "all, "
        "probably nowhere above 2 (threshold: " +
        fmt::format("{}", kAcceptedDifference) + ")";
    EXPECT_EQ(TextOf(Errors{clean, clean}), most);
    EXPECT_EQ(TextOf(Errors{clean, one}),
              most + ", except for a pixel that may be wrong by 7 in L*");
    EXPECT_TRUE(TextOf(Errors{one, some})
                    .ends_with(", except for 3 pixels that may be wrong by up to 21 in L*"));
}

void WithoutSpikes(Sampler& sampler, const Vec2i& pixel, uint32_t index, PathSample* sample) {
    SyntheticSample(sampler, pixel, index, sample);
    sample->radiance = sample->radiance.min(1.f);
}

// A large one is denoised at a lower resolution.
TEST(DenoisePreview, IsQuick) {
    const FeatureRender render(1, 36, WithoutSpikes);
    const DenoisedImage whole = DenoisePreview(render.film, kPictureRegion),
                        quick = DenoisePreview(render.film, kPictureRegion, 700);
    double sum = 0, sumOfQuick = 0;
    ASSERT_EQ(quick.image.values.size(), whole.image.values.size());
    for (size_t i = 0; i < whole.image.values.size(); ++i) {
        sum += double(whole.image.values[i]);
        sumOfQuick += double(quick.image.values[i]);
    }
    EXPECT_NEAR(sumOfQuick / sum, 1, 0.05);
    EXPECT_EQ(quick.image.width, kPictureRegion.Width());
    EXPECT_EQ(quick.error, std::vector<float>(60 * 40, kUnknownError));
    EXPECT_NE(whole.error, quick.error);
}

// Nothing of one eye's image depends on the other's.
TEST(DenoiseEyes, KeepsThemApart) {
    const FeatureRender render(1, 36, WithoutSpikes);
    const int eyeWidth = kPictureRegion.Width() / 2;
    for (const int mostPixels : {10000, 300}) {
        const auto denoise = [&](const PixelRect& eye, const std::vector<Block>&) {
            return DenoisePreview(render.film, eye, mostPixels);
        };
        const RgbImage both = DenoiseEyes(kPictureRegion, {}, eyeWidth, denoise).image;
        ASSERT_EQ(both.width, 2 * eyeWidth);
        for (size_t k = 0; k < 2; ++k) {
            const RgbImage eye = denoise(EyesOf(kPictureRegion, eyeWidth)[k], {}).image;
            for (int y = 0; y < both.height; ++y) {
                const size_t row = size_t(3 * eyeWidth), at = (2 * size_t(y) + k) * row;
                EXPECT_TRUE(std::equal(&both.values[at], &both.values[at] + row,
                                       &eye.values[size_t(y) * row]));
            }
        }
    }
}

// What the denoiser needs of a picture goes through files.

TEST(HalfChannels, AreReadAsTheyWere) {
    const FeatureRender render(1);
    const NoisyPicture picture = PictureOf(render.film, kPictureRegion);
    ExrImage exr;
    exr.width = 60;
    exr.height = 40;
    exr.channels = MakeHalfChannels(render.film, kPictureRegion);
    const NoisyPicture again = ReadPicture(exr, "a.exr");
    EXPECT_EQ(again.colour.a.values, picture.colour.a.values);
    EXPECT_EQ(again.features.values, picture.features.values);
    EXPECT_EQ(again.variance.values, picture.variance.values);
    EXPECT_EQ(again.emission.b.values, picture.emission.b.values);
    exr.channels.erase(exr.channels.begin());
    EXPECT_THROW(ReadPicture(exr, "a.exr"), Error);
}

// Two blocks of 100 pixels at a cap of 100: one stopped at 20 spp, one went on to the cap.
RenderResult TwoBlocks() {
    RenderResult result;
    result.blocks.resize(2);
    result.blocks[0].block = {
        .pixels = {{0, 0}, {10, 10}}, .spp = 20, .stopped = true, .stoppedByVote = true};
    result.blocks[0].seconds = 2;
    result.blocks[0].criterionSeconds = 1;
    result.blocks[0].decisions = {{20, {.value = 0.25, .threshold = 0.5, .votes = 1}}};
    result.blocks[0].block.noise = 0.5;
    result.blocks[1].block = {
        .pixels = {{10, 0}, {20, 10}}, .spp = 100, .votes = false, .leader = 0, .stopped = true};
    result.blocks[1].seconds = 20;
    result.progress = {.blocks = 2,
                       .stoppedBlocks = 2,
                       .blocksAtCap = 1,
                       .medianSpp = 100,
                       .samples = 12000,
                       .seconds = 12};
    return result;
}

TEST(ComputeSavings, ComparesWithEveryBlockAtTheCap) {
    const Savings savings = ComputeSavings(TwoBlocks(), 100);
    EXPECT_EQ(savings.samples, 12000);
    EXPECT_EQ(savings.samplesAtCount, 20000);
    EXPECT_DOUBLE_EQ(savings.SampleShare(), 0.4);
    EXPECT_DOUBLE_EQ(savings.secondsAtCount, 2 * 5 + 20);  // the slow block's samples cost more
    EXPECT_DOUBLE_EQ(savings.seconds, 23);
    EXPECT_DOUBLE_EQ(savings.criterionSeconds, 1);
    EXPECT_DOUBLE_EQ(savings.SecondShare(), 1 - 23. / 30);
}

TEST(ComputeSavings, SavesNothingWithoutABlock) {
    EXPECT_EQ(ComputeSavings({}, 100).SampleShare(), 0);
    EXPECT_EQ(ComputeSavings({}, 100).SecondShare(), 0);
}

TEST(ReportJson, HoldsBlocksTotalsAndProvenance) {
    Provenance provenance;
    provenance.version = "1.2.3";
    provenance.scene = "a \"quoted\" name\xff";
    provenance.seed = 0xffffffffffffffffull;
    provenance.criterion = "dammertz:0.02";
    provenance.schedule.cap = 100;
    const auto report = nlohmann::json::parse(
        Dump(ReportJson(provenance, TwoBlocks(), 3, {{"zero-area triangle", 7}}, nullptr)));
    EXPECT_EQ(report["provenance"]["seed"], 0xffffffffffffffffull);
    EXPECT_EQ(report["provenance"]["sampler"], "sobol");
    EXPECT_EQ(report["provenance"]["estimator"], "combined");
    EXPECT_EQ(report["totals"]["rejectedSamples"], 3);
    EXPECT_EQ(report["totals"]["samplesSaved"], 0.4);
    EXPECT_EQ(report["totals"]["cleanBlocks"], 1);
    EXPECT_EQ(report["totals"]["blocksAtCap"], 1);
    EXPECT_EQ(report["warnings"]["zero-area triangle"], 7);
    const auto& blocks = report["blocks"];
    ASSERT_EQ(blocks.size(), 2u);
    EXPECT_EQ(blocks[0]["end"], "clean");
    EXPECT_EQ(blocks[0]["maskedNoise"], 0.5);
    EXPECT_EQ(blocks[0]["threshold"], 20);
    EXPECT_EQ(blocks[0]["decisions"]["spp"], nlohmann::json({20}));
    EXPECT_EQ(blocks[0]["decisions"]["value"], nlohmann::json({0.25}));
    EXPECT_EQ(blocks[0]["decisions"]["votes"], nlohmann::json({1}));
    EXPECT_EQ(blocks[1]["end"], "cap");
    EXPECT_EQ(blocks[1]["x"], 10);
    EXPECT_EQ(blocks[1]["follows"], 0);
    EXPECT_FALSE(blocks[1].contains("decisions"));
}

}  // namespace

}  // namespace lull
