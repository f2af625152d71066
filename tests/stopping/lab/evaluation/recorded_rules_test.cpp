#include "stopping/lab/evaluation/recorded_rules.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "stopping/rules/rule_table.h"

namespace lull {
namespace {

TEST(RecordedRules, HaveAnEntryForEachRule) {
    ASSERT_EQ(RecordedRules().size(), RuleTable().size());
    const RuleContext context = {
        .models = LULL_SOURCE_DIR "/stopping/models",
        .measures = {{"denoised", [](const BlockView&, const BlockInfo&) { return Signals{}; }}}};
    for (size_t i = 0; i < RuleTable().size(); ++i) {
        const RuleEntry& rule = RuleTable()[i];
        const RecordedRule& recorded = RecordedRules()[i];
        const std::string name(rule.name);
        EXPECT_EQ(recorded.name, name);
        if (name == "thresholds") continue;  // reads a file
        const bool isComplete = rule.standard || rule.argument.starts_with('[');
        const Rule read = ParseRule(isComplete ? name : name + ":1", context);
        EXPECT_EQ(recorded.replay == Replay::Counts, bool(read.stopAt)) << name;
        EXPECT_EQ(recorded.replay == Replay::Decides, HasRecordedSignals(read)) << name;
        for (const double setting : recorded.curve)
            EXPECT_NO_THROW(ParseRule(name + ":" + std::to_string(setting))) << name;
        EXPECT_TRUE(std::ranges::is_sorted(recorded.curve, std::greater<>())) << name;
        EXPECT_GE(recorded.largest, recorded.least);
    }
    EXPECT_FALSE(HasRecordedSignals(ParseRule("dammertz:0.1:area")));
    EXPECT_EQ(FindRecordedRule("oracle:1"), nullptr);
}

}  // namespace
}  // namespace lull
