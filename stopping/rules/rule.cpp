#include "stopping/rules/rule.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "stopping/network/model_file.h"
#include "stopping/rules/learned.h"
#include "stopping/signals/lightness_noise.h"

namespace lull {

void Criterion::Restore(std::span<const std::byte> state) {
    if (!state.empty())
        throw std::runtime_error("the saved state belongs to another stopping rule");
}

RuleTrend TrendOfFalls(const NoiseVisibility& visibility) {
    return {.reference = visibility.reference, .nearness = visibility.nearness, .saturates = true};
}

RuleTrend TrendOf(const Model& model) {
    const double undecided = UndecidedNoise(model);
    // Otherwise its odds are followed, whatever it sees.
    RuleTrend trend = undecided > 0 ? TrendOfFalls(model.settings.visibility) : RuleTrend();
    trend.kind = RuleTrend::Probability;
    trend.votes = model.settings.votes;
    trend.undecided = undecided;
    return trend;
}

double UndecidedNoise(const Model& model) {
    const ModelSettings& settings = model.settings;
    if (!LooksAtNoiseOnly(settings)) return 0;
    // A step before the last had more noise; at fixed spacing, as much but for few spp.
    const double stepBefore =
        settings.spacing == Spacing::Geometric ? std::sqrt(settings.ratio) : 1.0;
    const auto isNoisy = [&](double noise) {
        Eigen::MatrixXf window(1, settings.k);
        for (int step = settings.k - 1; step >= 0; --step, noise *= stepBefore)
            window(0, step) = float(InputOfNoise(noise));
        return NoisyProbability(model.network, window) >= 0.5;
    };
    double clean = 1e-3, noisy = 1e3;
    if (isNoisy(clean) || !isNoisy(noisy)) return 0;
    while (noisy / clean > 1.0001) {
        const double middle = std::sqrt(clean * noisy);
        (isNoisy(middle) ? noisy : clean) = middle;
    }
    return noisy;
}

namespace {

// Stops a block at `spp` samples per pixel, or the end of the pass that reaches it.
class CountingCriterion final : public Criterion {
  public:
    explicit CountingCriterion(int spp) : target(spp) {}

    ViewNeed Need(int) const override { return ViewNeed::Nothing; }
    Decision Observe(const BlockView& view) override {
        CheckView(view, ViewNeed::Nothing);
        return {.stop = view.spp >= target,
                .checked = true,
                .value = double(view.spp),
                .threshold = double(target)};
    }

  private:
    int target;
};

}  // namespace

Rule CountingRule(std::function<int(const BlockInfo&)> stopAt) {
    return {.smallestSide = 0, .stopAt = std::move(stopAt)};
}

double PeakOverLimit(const Rule& rule, double peakNoise, int spp) {
    if (rule.peak.most <= 0) return 0;
    return peakNoise * NearnessFactor(spp, rule.peak.visibility) / rule.peak.most;
}

double RaisedByPeak(const Rule& rule, double number, double peakOverLimit) {
    if (peakOverLimit < 1) return number;
    // A probability p as its odds, of which 1 is the threshold 1/2.
    const double least = rule.trend.kind == RuleTrend::Probability
                             ? peakOverLimit / (1 + peakOverLimit)
                             : rule.threshold * peakOverLimit;
    return std::max(number, least);
}

RuleCriterion::RuleCriterion(std::shared_ptr<const Rule> given, const BlockInfo& block)
    : rule(std::move(given)),
      block(block),
      statistic(rule->makeStatistic ? rule->makeStatistic() : nullptr),
      value(rule->valueBefore) {}

Decision RuleCriterion::Decide(int spp, Signals signals, double peakOverLimit) {
    if (spp < last) throw std::invalid_argument("a block must be shown with increasing spp");
    std::optional<double> number;
    if (IsDue(spp)) {
        last = spp;
        number = statistic ? statistic->Add(spp, std::move(signals)) : std::get<double>(signals);
    }
    if (number) {
        peak = peakOverLimit;
        value = RaisedByPeak(*rule, *number, peak);
        votes = value < rule->threshold ? votes + 1 : 0;
    }
    return {.stop = number && votes >= std::max(1, rule->votes),
            .checked = number.has_value(),
            .value = value,
            .threshold = rule->threshold,
            .votes = rule->votes > 0 ? votes : 0};
}

ViewNeed RuleCriterion::Need(int spp) const { return IsDue(spp) ? rule->need : ViewNeed::Nothing; }

Decision RuleCriterion::Observe(const BlockView& view) {
    CheckView(view, Need(view.spp));
    if (!IsDue(view.spp)) return Decide(view.spp, {});
    const bool showsPeak = rule->peak.most > 0 && !view.halfMean.empty();
    double noise = 0;
    if (showsPeak) {
        const LightnessNoise pixels = ComputeLightnessNoise(view);
        noise = std::max(PeakNoise(pixels), LocalPeakNoise(pixels, view.width, view.height));
    }
    return Decide(view.spp,
                  rule->inputs ? MeasureBlock(view, *rule->inputs) : rule->measure(view, block),
                  PeakOverLimit(*rule, noise, view.spp));
}

std::optional<double> RuleCriterion::NetworkNoise() const {
    std::optional<double> noise = statistic ? statistic->Noise() : std::nullopt;
    // At the limit of peak noise the network counts as undecided.
    if (noise) noise = std::max(*noise, rule->trend.undecided * peak);
    return noise;
}

std::vector<std::byte> RuleCriterion::Save() const {
    StateWriter writer;
    writer.Put(rule->tag);
    writer.Put(value);
    writer.Put(peak);
    writer.Put(int32_t(last));
    writer.Put(int32_t(votes));
    if (statistic) statistic->Save(&writer);
    return std::move(writer.bytes);
}

void RuleCriterion::Restore(std::span<const std::byte> state) {
    StateReader reader(state);
    reader.Expect(rule->tag);
    value = reader.Get<double>();
    peak = reader.Get<double>();
    last = reader.Get<int32_t>();
    votes = reader.Get<int32_t>();
    if (!(value >= 0) || !(peak >= 0) || last < 0 || votes < 0)
        throw std::runtime_error("the saved state of a stopping rule is damaged");
    if (statistic) statistic->Restore(&reader);
    reader.Finish();
}

std::unique_ptr<Criterion> MakeCriterion(std::shared_ptr<const Rule> rule, const BlockInfo& block) {
    if (rule->stopAt) return std::make_unique<CountingCriterion>(rule->stopAt(block));
    return std::make_unique<RuleCriterion>(std::move(rule), block);
}

std::unique_ptr<Criterion> MakeCriterion(Rule rule, const BlockInfo& block) {
    return MakeCriterion(std::make_shared<const Rule>(std::move(rule)), block);
}

CriterionMaker CriteriaOf(Rule rule) {
    return [rule = std::make_shared<const Rule>(std::move(rule))](const BlockInfo& block) {
        return MakeCriterion(rule, block);
    };
}

const SignalMeasure& SuppliedMeasure(const RuleContext& context, const std::string& rule) {
    const auto measure = context.measures.find(rule);
    if (measure == context.measures.end())
        throw std::invalid_argument(
            "it needs measurements of blocks that this program does not make");
    return measure->second;
}

}  // namespace lull
