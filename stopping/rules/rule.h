// Defines stopping rules: "the number of a block was below a threshold at three checks in a row".
//
// A Rule defines the measurement of a block, the Checks at which it is made, and the threshold. A
// Statistic computes the compared number from the measurements. A Criterion is a rule at work on
// one block: it counts the checks in a row that were below the threshold. Renders measure a block;
// recordings have its measurements, on which the same decisions are made.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "stopping/base/state.h"
#include "stopping/features/model_inputs.h"
#include "stopping/rules/criterion.h"
#include "stopping/rules/trend.h"

namespace lull {

// A rule checks a block at first, first + every, first + 2 every, ... spp; or, where pictures come
// at any spp, at whatever comes `every` spp or more after the last check.
struct Checks {
    int first = 1;      // the least spp of a check, > 0
    int every = 1;      // spp from one to the next, > 0
    double growth = 1;  // of the spp from one to the next, at the least
    bool any = false;   // pictures come at any spp

    // Returns whether a check is due at `spp` > 0, after one at `last` spp; 0: there was none.
    bool AreDue(int spp, int last = 0) const {
        if (spp < first || spp < growth * last) return false;
        return any ? last == 0 || spp - last >= every : (spp - first) % every == 0;
    }
};

// A number for each pixel, row by row.
struct PixelErrors {
    int width = 0;
    std::vector<double> errors = {};
};

// What a rule gets after a pass of a block, measured in a render or recorded: nothing but the
// spp; one number of the block; one of each pixel; inputs of networks.
using Signals = std::variant<std::monostate, double, PixelErrors, BlockMeasures>;

// Computes the number of one block from its signals, and stores the state this needs.
class Statistic {
  public:
    virtual ~Statistic() = default;

    // Adds the signals of a check, whose spp increase. Returns the number, at least 0 and not NaN;
    // nothing where there is no earlier check to compare with. Throws std::invalid_argument.
    virtual std::optional<double> Add(int spp, Signals signals) = 0;

    // Returns the noise of the last number, if that depends on nothing else.
    virtual std::optional<double> Noise() const { return {}; }

    // Write and read the state after Add(). Restore() throws std::runtime_error if it is
    // damaged.
    virtual void Save(StateWriter*) const = 0;
    virtual void Restore(StateReader*) = 0;
};

// Measures the signals of a rule in a block.
using SignalMeasure = std::function<Signals(const BlockView& view, const BlockInfo& block)>;

// Limit of the peak noise of a block (PeakNoise() in signals/lightness_noise.h), from which on a
// check is no vote to stop, whatever the number: few pixels with much noise, as of thin lights and
// fireflies, hardly move a mean over the block.
struct PeakLimit {
    double most = 0;  // in L*; 0: no limit
    // Of the peak noise NearnessFactor() counts.
    NoiseVisibility visibility = {.nearness = 0};
};

struct Rule {
    std::string text = {};      // as it was given, for headers and reports
    std::string checksum = {};  // of the file that it reads; empty if it reads none
    RuleTrend trend = {};
    // Pixels a side below which a block is not checked, but follows a neighbour (block_grid.h).
    int smallestSide = kSmallestVotingSide;
    uint32_t tag = 0;  // tells saved states of its criteria from those of others

    Checks checks = {};
    double threshold = 0;
    int votes = 0;  // checks in a row below it that stop a block; 0: one does, and none is counted
    PeakLimit peak = {};
    ViewNeed need = ViewNeed::MeanAndHalf;  // of the measurement
    // Measures by MeasureBlock() with these settings or, where there are none, by `measure`.
    std::optional<ModelSettings> inputs = {};
    SignalMeasure measure = {};
    // Empty: the number is the measurement itself.
    std::function<std::unique_ptr<Statistic>()> makeStatistic = {};
    double valueBefore = 0;  // the number of a block that has none yet
    int spacing = 0;         // spp between two states that it compares; 0: any

    // In place of all these, for rules that only count samples: the spp at which a block stops,
    // known before the pass has ended. Throws std::invalid_argument for a block that the rule has
    // no answer for.
    std::function<int(const BlockInfo&)> stopAt = {};
};

// Returns the peak noise of a block at `spp` over the rule's limit; 0 without a limit.
double PeakOverLimit(const Rule& rule, double peakNoise, int spp);

// Returns the number of a check: unchanged where the peak noise is below the limit; else at least
// the threshold times `peakOverLimit` (odds of a probability), so that reports and forecasts
// follow it.
double WithPeak(const Rule& rule, double number, double peakOverLimit);

// Limit of peak noise / threshold, for rules that are not trained: the mean ratio of viewpoints at
// human thresholds (docs/entropy.md).
inline constexpr double kPeakOverThreshold = 2;

// Returns the rule that stops blocks at `stopAt`.
Rule CountingRule(std::function<int(const BlockInfo&)> stopAt);

// Applies a rule with a threshold to one block.
class RuleCriterion final : public Criterion {
  public:
    RuleCriterion(std::shared_ptr<const Rule> rule, const BlockInfo& block);

    bool IsDue(int spp) const { return rule->checks.AreDue(spp, last); }
    // Decides after a pass. Signals and PeakOverLimit() (0: not known) are read only where a check
    // is due. Throws std::invalid_argument as the statistic does.
    Decision Decide(int spp, Signals signals, double peakOverLimit = 0);

    ViewNeed Need(int spp) const override;
    Decision Observe(const BlockView& view) override;
    std::optional<double> NetworkNoise() const override;
    std::vector<std::byte> Save() const override;
    void Restore(std::span<const std::byte> state) override;

  private:
    std::shared_ptr<const Rule> rule;
    BlockInfo block;
    std::unique_ptr<Statistic> statistic;  // null: the number is the measurement
    double value;                          // the last number
    double peak = 0;                       // PeakOverLimit() at the last check
    int last = 0;                          // spp of the last check; 0: there was none
    int votes = 0;                         // checks in a row below the threshold
};

// Makes the criterion of one block. Throws as Rule::stopAt does.
std::unique_ptr<Criterion> MakeCriterion(std::shared_ptr<const Rule> rule,
                                         const BlockInfo& block = {});
std::unique_ptr<Criterion> MakeCriterion(Rule rule, const BlockInfo& block = {});
// Returns the maker of the criteria of all blocks of an image.
CriterionMaker CriteriaOf(Rule rule);

// Context of a rule, in addition to its text.
struct RuleContext {
    int passSpp = 20;            // spp of a pass, also of the first; 0: any (see Checks)
    int blockCount = 0;          // blocks in the image; 0: not known
    int cap = 0;                 // spp that no block exceeds; 0: not known
    std::string sceneName = {};  // the row that `thresholds:FILE` takes; may be empty
    std::string models = {};     // the folder of installed models, NAME.h5; may be empty
    // 2 allows half as much visible noise: multiplies the noise that a network receives, divides
    // thresholds and the limit of peak noise. Above 0; others than 1 only for rules that measure
    // visible noise.
    double caution = 1;
    // Whether views come with half means. Otherwise rules whose number needs none ask for none, and
    // limit peak noise only where a view has one.
    bool hasHalves = true;
    // Measurements of the program that a BlockView does not contain, by the name of the rule. A
    // rule that needs one is refused where it is missing.
    std::map<std::string, SignalMeasure> measures = {};
};

// Returns the program's measurement for a rule. Throws std::invalid_argument if there is none.
const SignalMeasure& SuppliedMeasure(const RuleContext& context, const std::string& rule);

}  // namespace lull
