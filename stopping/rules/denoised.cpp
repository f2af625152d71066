#include "stopping/rules/denoised.h"

#include "stopping/rules/argument.h"

namespace lull {

namespace {

constexpr uint32_t kTag = 0x33534e44;  // "DNS3"
constexpr int kVotes = 1;
constexpr int kFirstSpp = 20;
constexpr double kGrowth = 1.25;

}  // namespace

Rule ReadDenoised(const std::string& argument, const RuleContext& context) {
    return {.tag = kTag,
            .checks = {.first = kFirstSpp, .growth = kGrowth},
            .threshold = ParseThreshold(argument) / context.caution,
            .votes = kVotes,
            .need = ViewNeed::Measured,
            .measure = SuppliedMeasure(context, kDenoisedRuleName)};
}

}  // namespace lull
