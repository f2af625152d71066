// Makes a rule of what it measures of a block, the number it makes of that, and a threshold that
// the number has to be below so many times in a row. Renders measure a block and decide; on a
// recording what was measured is read, and decided on in the same way.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>

#include "stopping/base/state.h"
#include "stopping/features/recorded_measures.h"
#include "stopping/rules/criterion.h"
#include "stopping/rules/signals.h"
#include "stopping/rules/votes.h"

namespace lull {

// Makes the number of one block from its signals, and remembers what that takes.
class Gauge {
  public:
    virtual ~Gauge() = default;

    // Says whether the block is looked at at this spp.
    virtual bool Looks(int) const { return true; }

    // Takes note of the signals at an spp that Looks(), more than the last. Returns whether there
    // is a new number: there may be nothing yet to compare with.
    virtual bool Add(int spp, Signals signals) = 0;

    double Value() const { return value; }  // the last number; never NaN
    // The noise that the last number was made of, where it was made of nothing else.
    virtual std::optional<double> Noise() const { return {}; }

    // Write and read what Add() has left behind. Restore() throws std::runtime_error if it is
    // damaged.
    virtual void Save(StateWriter*) const {}
    virtual void Restore(StateReader*) {}

  protected:
    double value = 0;
};

// Says when a gauge for numbers that are measured as they are looks at a block.
struct Looking {
    int firstSpp = 0;
    double growth = 1;  // from then on, wherever the spp have grown by this factor
};

// Makes a gauge whose number is `factor` times the one that is measured.
std::unique_ptr<Gauge> MakeMeasuredGauge(double factor = 1, const Looking& looking = {});

struct VotingRule {
    double threshold = 0;
    int votes = 0;     // in a row that stop a block; 0: the first number below the threshold does
    uint32_t tag = 0;  // tells its saved states from those of others; 0: it has nothing to save
    ViewNeed need = ViewNeed::MeanAndHalf;  // of `measure`
    SignalMeasure measure = {};
    // Returns from a recording what `measure` would have; empty: that is not recorded.
    std::function<Signals(int spp, const RecordedValues& values)> recall = {};
    std::function<std::unique_ptr<Gauge>(const BlockInfo&)> makeGauge = {};
    bool isVisibleNoise = false;  // whether its number is VisibleNoise() (lnoise.h)
    int spacing = 0;  // spp between two states that it compares; 0: it takes what there is
};

// Decides on one block, from its signals.
class Decider {
  public:
    Decider(const VotingRule& rule, const BlockInfo& block);

    bool Looks(int spp) const { return gauge->Looks(spp); }
    // Decides after a pass. Signals are read only where it Looks(). Throws std::invalid_argument as
    // the gauge does.
    Decision Decide(int spp, Signals signals);

    std::vector<std::byte> Save() const;
    void Restore(std::span<const std::byte> state);

  private:
    double threshold;
    bool isVoting, isVisibleNoise;
    uint32_t tag;
    std::unique_ptr<Gauge> gauge;
    VoteCounter votes;
};

// Returns what makes the criteria of an image, with what follows from the rule.
CriterionFactory FactoryOf(VotingRule rule);

// Returns what the program measures for a rule. Throws std::invalid_argument if it does not.
const SignalMeasure& SuppliedMeasure(const RuleContext& context, const std::string& rule);

// Makes the criterion of one block.
std::unique_ptr<Criterion> MakeVoting(std::shared_ptr<const VotingRule> rule,
                                      const BlockInfo& block = {});
std::unique_ptr<Criterion> MakeVoting(VotingRule rule, const BlockInfo& block = {});

}  // namespace lull
