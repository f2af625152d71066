#include "renderer/results/denoised_image.h"

#include <gtest/gtest.h>

#include "renderer/vision/visible_difference.h"
#include "stopping/rules/denoised.h"
#include "stopping/rules/rule_table.h"
#include "tests/renderer/render/feature_render.h"

namespace lull {
namespace {

// The rule's default stands in its table as text.
TEST(DenoisedImage, IsAcceptedWhereTheRuleStops) {
    RuleContext context;
    context.measures[kDenoisedRuleName] = [](const BlockView&, const BlockInfo&) -> Signals {
        return 0.0;
    };
    EXPECT_EQ(ParseRule(kDenoisedRuleName, context).threshold, kVisibilityThreshold);
}

PathSample WithoutSpikes(Sampler& sampler, const Vec2i& pixel, uint32_t index,
                         const SampleDetail& detail) {
    PathSample sample = SyntheticSample(sampler, pixel, index, detail);
    sample.radiance = sample.radiance.min(1.f);
    return sample;
}

// A large one is denoised at a lower resolution.
TEST(DenoisePreview, IsQuick) {
    const FeatureRender render(1, 36, WithoutSpikes);
    const DenoisedImage whole = DenoisePreview(render.film),
                        quick = DenoisePreview(render.film, 700);
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

}  // namespace
}  // namespace lull
