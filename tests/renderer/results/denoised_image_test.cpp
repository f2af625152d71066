#include "renderer/results/denoised_image.h"

#include <gtest/gtest.h>

#include "renderer/vision/visible_difference.h"
#include "stopping/rules/denoised.h"
#include "stopping/rules/rule_table.h"

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

}  // namespace
}  // namespace lull
