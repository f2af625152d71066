#include "stopping/rules/entropy.h"

#include <cmath>
#include <cstdint>
#include <stdexcept>

#include "stopping/rules/argument.h"

namespace lull {

namespace {

constexpr uint32_t kEntropyTag = 0x32504445;  // "EDP2"
constexpr int kCheckSpacing = 40;             // spp

class EntropyStatistic final : public Statistic {
  public:
    explicit EntropyStatistic(const NoiseVisibility& visibility) : visibility(visibility) {}

    // There is a number where there is an earlier state to compare with.
    std::optional<double> Add(int spp, Signals signals) override {
        const BlockMeasures& measures = std::get<BlockMeasures>(signals);
        AddEntropies(spp, measures.Of(Feature::H), &history);
        const auto visible = LatestVisibleDrop(history, measures.lightness, visibility);
        if (!visible) return {};
        return MeanVisible(*visible);
    }

    void Save(StateWriter* writer) const override { history.Save(writer); }
    void Restore(StateReader* reader) override {
        history.Restore(reader, size_t(kEntropySubBlocks));
    }

  private:
    NoiseVisibility visibility;
    History<float> history;
};

}  // namespace

Checks EntropyChecks(int passSpp) {
    if (passSpp == 0) return {.every = kCheckSpacing, .any = true};
    return {.first = passSpp, .every = (kCheckSpacing + passSpp - 1) / passSpp * passSpp};
}

double MeanVisible(std::span<const double> visibleDrops) {
    double sum = 0;
    for (const double v : visibleDrops) sum += v;
    return sum / double(visibleDrops.size());
}

Rule EntropyRule(double threshold, const NoiseVisibility& visibility, int passSpp) {
    return {.tag = kEntropyTag,
            .checks = EntropyChecks(passSpp),
            .threshold = threshold,
            .votes = 3,
            .need = ViewNeed::Mean,
            .inputs = ModelSettings{.m = kEntropySubBlocks, .features = {Feature::VisibleDrop}},
            .makeStatistic = [=] { return std::make_unique<EntropyStatistic>(visibility); }};
}

Rule ReadEntropy(const std::string& argument, const RuleContext& context) {
    const double threshold = ParseThreshold(argument) / context.caution;
    const NoiseVisibility visibility = VisibilityAt(context.cap, {});
    Rule rule = EntropyRule(threshold, visibility, context.passSpp);
    rule.trend = TrendOfFalls(visibility);
    rule.peak = {.most = kPeakOverThreshold * threshold, .visibility = visibility};
    return rule;
}

}  // namespace lull
