#include "stopping/rules/voting.h"

#include <algorithm>
#include <stdexcept>
#include <utility>

namespace lull {

namespace {

class MeasuredGauge final : public Gauge {
  public:
    MeasuredGauge(double factor, const Looking& looking) : factor(factor), looking(looking) {}

    bool Looks(int spp) const override {
        return spp >= looking.firstSpp && spp >= looking.growth * last;
    }
    bool Add(int spp, Signals signals) override {
        last = spp;
        value = factor * std::get<double>(signals);
        return true;
    }
    // Where it looks at every pass there is nothing to remember.
    void Save(StateWriter* writer) const override {
        if (looking.growth <= 1) return;
        writer->Put(value);
        writer->Put(int32_t(last));
    }
    void Restore(StateReader* reader) override {
        if (looking.growth <= 1) return;
        value = reader->Get<double>();
        last = reader->Get<int32_t>();
        if (!(value >= 0) || last < 0)
            throw std::runtime_error("the saved state of a stopping rule is damaged");
    }

  private:
    double factor;
    Looking looking;
    int last = 0;  // spp; 0: it has not looked yet
};

class VotingCriterion final : public Criterion {
  public:
    VotingCriterion(std::shared_ptr<const VotingRule> rule, const BlockInfo& block)
        : rule(std::move(rule)), block(block), decider(*this->rule, block) {}

    ViewNeed Need(int spp) const override {
        return decider.Looks(spp) ? rule->need : ViewNeed::Nothing;
    }
    Decision Observe(const BlockView& view) override {
        CheckView(view, Need(view.spp));
        return decider.Decide(view.spp,
                              decider.Looks(view.spp) ? rule->measure(view, block) : Signals());
    }
    std::vector<std::byte> Save() const override { return decider.Save(); }
    void Restore(std::span<const std::byte> state) override { decider.Restore(state); }

  private:
    std::shared_ptr<const VotingRule> rule;
    BlockInfo block;
    Decider decider;
};

}  // namespace

std::unique_ptr<Gauge> MakeMeasuredGauge(double factor, const Looking& looking) {
    return std::make_unique<MeasuredGauge>(factor, looking);
}

Decider::Decider(const VotingRule& rule, const BlockInfo& block)
    : threshold(rule.threshold),
      isVoting(rule.votes > 0),
      isVisibleNoise(rule.isVisibleNoise),
      tag(rule.tag),
      gauge(rule.makeGauge(block)),
      votes{.needed = isVoting ? rule.votes : 1} {}

Decision Decider::Decide(int spp, Signals signals) {
    const bool judged = Looks(spp) && gauge->Add(spp, std::move(signals));
    const double value = gauge->Value();
    if (judged) votes.Cast(value, threshold);
    Decision decision{.stop = judged && votes.Stops(),
                      .judged = judged,
                      .value = value,
                      .threshold = threshold,
                      .votes = isVoting ? votes.inRow : 0};
    if (judged && isVisibleNoise) decision.visibleNoise = value;
    if (judged) decision.noise = gauge->Noise();
    return decision;
}

std::vector<std::byte> Decider::Save() const {
    StateWriter writer;
    if (tag == 0) return {};
    writer.Put(tag);
    if (isVoting) writer.Put(int32_t(votes.inRow));
    gauge->Save(&writer);
    return std::move(writer.bytes);
}

void Decider::Restore(std::span<const std::byte> state) {
    if (tag == 0) {
        if (!state.empty())
            throw std::runtime_error("the saved state belongs to another stopping rule");
        return;
    }
    StateReader reader(state);
    reader.Expect(tag);
    if (isVoting) votes.inRow = reader.Get<int32_t>();
    if (votes.inRow < 0) throw std::runtime_error("the saved state of a stopping rule is damaged");
    gauge->Restore(&reader);
    reader.Finish();
}

CriterionFactory FactoryOf(VotingRule rule) {
    const auto shared = std::make_shared<const VotingRule>(std::move(rule));
    return {.trend = {.votes = std::max(1, shared->votes)},
            .smallestSide = smallestVotingSide,
            .make = [shared](const BlockInfo& block) { return MakeVoting(shared, block); },
            .voting = shared};
}

const SignalMeasure& SuppliedMeasure(const RuleContext& context, const std::string& rule) {
    const auto measure = context.measures.find(rule);
    if (measure == context.measures.end())
        throw std::invalid_argument("it looks at more of a block than this program shows it");
    return measure->second;
}

std::unique_ptr<Criterion> MakeVoting(std::shared_ptr<const VotingRule> rule,
                                      const BlockInfo& block) {
    return std::make_unique<VotingCriterion>(std::move(rule), block);
}

std::unique_ptr<Criterion> MakeVoting(VotingRule rule, const BlockInfo& block) {
    return MakeVoting(std::make_shared<const VotingRule>(std::move(rule)), block);
}

}  // namespace lull
