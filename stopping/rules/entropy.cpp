#include "stopping/rules/entropy.h"

#include <cmath>
#include <cstdint>
#include <stdexcept>

#include "stopping/rules/argument.h"
#include "stopping/signals/drop_history.h"

namespace lull {

namespace {

constexpr uint32_t entropyTag = 0x31504445;  // "EDP1"

class EntropyGauge final : public Gauge {
  public:
    EntropyGauge(const NoiseVisibility& visibility, int passSpp)
        : visibility(visibility), passSpp(passSpp) {}

    bool Looks(int spp) const override {
        return passSpp == 0 ? looks.Looks(spp) : EntropyRuleLooks(spp, passSpp);
    }

    // There is a number where there is an earlier state to compare with.
    bool Add(int spp, Signals signals) override {
        looks.last = spp;
        const BlockMeasures& measures = std::get<BlockMeasures>(signals);
        const auto visible = AddVisible(spp, measures.Of(Feature::H), measures.lightness,
                                        VisibilityWith(measures.variance, visibility), &history);
        if (visible) value = MeanVisible(*visible);
        return visible.has_value();
    }

    void Save(StateWriter* writer) const override {
        writer->Put(value);
        history.Save(writer);
        if (passSpp == 0) writer->Put(int32_t(looks.last));
    }
    void Restore(StateReader* reader) override {
        value = reader->Get<double>();
        if (!(value >= 0) || !std::isfinite(value))
            throw std::runtime_error("the saved state of the rule entropy is damaged");
        history.Restore(reader, size_t(kEntropySubBlocks));
        if (passSpp == 0) looks.Restore(reader);
    }

  private:
    NoiseVisibility visibility;
    int passSpp;
    FreeLooks looks;  // where passSpp is 0
    DropHistory history;
};

// Says what is measured: entropies, and the lightness that makes their falls visible.
ModelSettings MeasuredSettings() {
    return {.m = kEntropySubBlocks, .features = {Feature::VisibleDrop}};
}

}  // namespace

bool EntropyRuleLooks(int spp, int passSpp) {
    const int spacing = (40 + passSpp - 1) / passSpp * passSpp;
    return spp >= passSpp && (spp - passSpp) % spacing == 0;
}

double MeanVisible(std::span<const double> visibleDrops) {
    double sum = 0;
    for (const double v : visibleDrops) sum += v;
    return sum / double(visibleDrops.size());
}

VotingRule EntropyRule(double threshold, const NoiseVisibility& visibility, int passSpp) {
    return {
        .threshold = threshold,
        .votes = VoteCounter().needed,
        .tag = entropyTag,
        .need = ViewNeed::Mean,
        .measure = [settings = MeasuredSettings()](
                       const BlockView& view,
                       const BlockInfo&) { return MeasureBlock(view, settings); },
        .recall =
            [settings = MeasuredSettings()](int spp, const RecordedValues& values) {
                return RecordedMeasures(spp, values, settings);
            },
        .makeGauge =
            [=](const BlockInfo&) { return std::make_unique<EntropyGauge>(visibility, passSpp); }};
}

CriterionFactory ReadEntropy(const std::string& argument, const RuleContext& context) {
    const double threshold = ParseThreshold(argument) / context.caution;
    const NoiseVisibility visibility = VisibilityAt(context.cap, context.visibility);
    CriterionFactory factory = FactoryOf(EntropyRule(threshold, visibility, context.passSpp));
    const int votes = factory.trend.votes;
    factory.trend = TrendOfFalls(visibility);
    factory.trend.votes = votes;
    return factory;
}

}  // namespace lull
