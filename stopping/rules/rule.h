// Defines stopping rules: "the number of a block was below a threshold at three checks in a row".
//
// A Rule defines the measurement of a block, the Checks at which it is made, and the threshold. A
// Statistic computes the compared number from the measurements. A Criterion is a rule at work on
// one block: it counts the checks in a row that were below the threshold. Renders measure a block;
// recordings have its measurements, on which the same decisions are made.
#pragma once

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <variant>
#include <vector>

#include "stopping/base/block_view.h"
#include "stopping/base/input_file.h"
#include "stopping/base/state.h"
#include "stopping/features/model_inputs.h"

namespace lull {

// Defines the one interface between renderer and stopping rules: after each pass a block is shown
// to its criterion, which answers continue or stop.

// Answer of a criterion. No number in it is ever NaN.
struct Decision {
    bool stop = false;
    // Whether the block was checked in this call; if not, the numbers are the last check's.
    bool checked = false;
    double value = 0;      // an error estimate, P(noisy) or the spp
    double threshold = 0;  // of the value
    int votes = 0;         // checks in a row that were below it (rules that vote only)
};

// Decides on one block over all its passes, with the state of its earlier checks. Different
// criteria can be used by different threads at the same time.
class Criterion {
  public:
    virtual ~Criterion() = default;

    // Returns the spans that Observe() will read at `spp`, so that no view is built in vain.
    virtual ViewNeed Need(int spp) const = 0;

    // Adds the block after a pass and decides. To be called once after every pass, with increasing
    // spp, whatever Need() returns, and no more once it has answered stop. Throws
    // std::invalid_argument if spans, size or spp contradict Need() or earlier calls.
    virtual Decision Observe(const BlockView& view) = 0;

    // Returns the noise given to a network at the last check, if it has no other input: forecasts
    // follow it in place of the probability (rule.h).
    virtual std::optional<double> NetworkNoise() const { return {}; }

    // Return and set the state that Observe() keeps between calls, for checkpoints. Restore()
    // throws std::runtime_error if `state` was saved by another rule or is damaged; the criterion
    // must not be used afterwards.
    virtual std::vector<std::byte> Save() const { return {}; }
    virtual void Restore(std::span<const std::byte> state);
};

struct BlockInfo {
    int index = 0;            // row-major place in the grid of blocks
    double areaFraction = 1;  // pixels of the block / pixels of the image, in (0, 1]
};

// Makes a block's own criterion, in any thread.
using CriterionMaker = std::function<std::unique_ptr<Criterion>(const BlockInfo&)>;

// Reads the arguments of stopping rules.

// Parses `text` as a finite number > 0. Throws std::invalid_argument with `needed`, its noun.
template <typename T>
T ParsePositive(const std::string& text, const std::string& needed) {
    T value = 0;
    const char* end = text.data() + text.size();
    const auto [rest, error] = std::from_chars(text.data(), end, value);
    if (error != std::errc() || rest != end || !(value > 0) || !std::isfinite(double(value)))
        throw std::invalid_argument("'" + Printable(text) + "' is not " + needed);
    return value;
}

inline double ParseThreshold(const std::string& text) {
    return ParsePositive<double>(text, "a threshold; a number > 0 is needed");
}

// Describes the course of a rule's number over the samples, from which stops are predicted.

struct Model;

struct RuleTrend {
    enum Kind {
        Error,        // above 0; falls as a power of the spp
        Probability,  // in [0, 1]; falls too
        Samples       // the spp themselves, which rise to the threshold
    };
    Kind kind = Error;
    int votes = 1;  // in a row that stop a block
    // Noise at which a network with no other input is undecided. Predictions follow the noise then,
    // as a probability is no power of the spp. 0: not known.
    double undecided = 0;
    // Spp of the picture compared with, 0: none: noise counts (1 - spp / reference)^nearness.
    int reference = 0;
    double nearness = 0.5;
    // Whether it falls more slowly where there is much noise, as falls of entropies do.
    bool saturates = false;
    // The power of the spp that it follows, < 0, where that is the same in all blocks; 0: fitted.
    double power = 0;
    // Quantiles, 9 and 91 %, of the exponents of forecasts (RangeOfRest() of forecast.h).
    std::array<double, 2> exponents = {0.86, 1.19};
};

struct NoiseVisibility;

// Returns the trend of visible falls of entropies (svd_entropy.h).
RuleTrend TrendOfFalls(const NoiseVisibility& visibility);

// Returns the trend of a model's answers, or of its noise input.
RuleTrend TrendOf(const Model& model);

// Returns the noise, times the caution, above which a model takes a block for noisy. It is defined
// for models with no input but noise, whose window then has the noise of earlier steps too: at
// geometric spacing as if it had fallen with the root of the spp, at fixed spacing as if it were
// the same. 0 for other models, and where the limit is not between 0.001 and 1000.
double UndecidedNoise(const Model& model);

// A rule checks a block at first, first + every, first + 2 every, ... spp; or, where pictures come
// at any spp, at whatever comes `every` spp or more after the last check.
struct Checks {
    int first = 1;  // the least spp of a check, > 0
    int every = 1;  // spp from one to the next, > 0
    // Of the spp from one to the next, at the least. Near the threshold it is the growth in which
    // a number that falls as 1 / spp, as visible differences do at the fastest, comes down to it,
    // but kLeastGrowth if that is more.
    double growth = 1;
    bool any = false;  // pictures come at any spp

    static constexpr double kLeastGrowth = 1.03;

    // Returns whether a check is due at `spp` > 0, after one at `last` spp whose number was `over`
    // times the threshold; 0: there was none.
    bool AreDue(int spp, int last = 0,
                double over = std::numeric_limits<double>::infinity()) const {
        const double needed = std::min(growth, std::max(kLeastGrowth, over));
        if (spp < first || spp < needed * last) return false;
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

    // Write and read the state. Restore() throws std::runtime_error if it is damaged.
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
    // Pixels a side below which a block is not checked, but follows a neighbour (thresholds.h).
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
    // known before the pass has ended. Throws std::invalid_argument for unknown blocks.
    std::function<int(const BlockInfo&)> stopAt = {};
};

// Returns the peak noise of a block at `spp` over the rule's limit; 0 without a limit.
double PeakOverLimit(const Rule& rule, double peakNoise, int spp);

// Returns the number of a check: unchanged where the peak noise is below the limit; else at least
// the threshold times `peakOverLimit` (odds of a probability), so that reports and forecasts
// follow it.
double RaisedByPeak(const Rule& rule, double number, double peakOverLimit);

// Limit of peak noise / threshold, for rules that are not trained: the mean ratio of viewpoints at
// human thresholds (docs/entropy.md).
inline constexpr double kPeakOverThreshold = 2;

// Returns the rule that stops blocks at `stopAt`.
Rule CountingRule(std::function<int(const BlockInfo&)> stopAt);

// Applies a rule with a threshold to one block.
class RuleCriterion final : public Criterion {
  public:
    RuleCriterion(std::shared_ptr<const Rule> rule, const BlockInfo& block);

    bool IsDue(int spp) const { return rule->checks.AreDue(spp, last, value / rule->threshold); }
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
