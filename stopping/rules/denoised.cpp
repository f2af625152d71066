#include "stopping/rules/denoised.h"

#include "stopping/rules/argument.h"

namespace lull {

namespace {

constexpr uint32_t kTag = 0x31534e44;  // "DNS1"
constexpr int kVotes = 1;
constexpr int kFirstSpp = 20;
constexpr double kGrowth = 1.25;

}  // namespace

CriterionFactory ReadDenoised(const std::string& argument, const RuleContext& context) {
    return FactoryOf({.threshold = ParseThreshold(argument) / context.caution,
                      .votes = kVotes,
                      .tag = kTag,
                      .need = ViewNeed::Measured,
                      .measure = SuppliedMeasure(context, denoisedRuleName),
                      .makeGauge = [](const BlockInfo&) {
                          return MakeMeasuredGauge(1, {.firstSpp = kFirstSpp, .growth = kGrowth});
                      }});
}

}  // namespace lull
