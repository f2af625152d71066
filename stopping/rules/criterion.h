// Defines the one interface between renderer and stopping rules: after each pass a block is shown
// to its criterion, which answers continue or stop.
#pragma once

#include <cstddef>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "stopping/base/block_view.h"
#include "stopping/rules/signals.h"
#include "stopping/rules/trend.h"
#include "stopping/signals/entropy_drop.h"

namespace lull {

// Records an answer of a criterion. No number in it is ever NaN.
struct Decision {
    bool stop = false;
    // Whether the block was looked at in this call; if not, the numbers are those of the last time.
    bool judged = false;
    double value = 0;      // what was compared: an error estimate, P(noisy) or the spp
    double threshold = 0;  // what it was compared with
    int votes = 0;         // noiseless votes in a row (rules that vote only)
    // The block's VisibleNoise() (lnoise.h), from rules that compute it anyhow.
    std::optional<double> visibleNoise = {};
    // The noise that a network was told, where that is all it looks at.
    std::optional<double> noise = {};
};

// Judges one block over all its passes and holds what that needs to remember. Different criteria
// can be used by different threads at the same time.
class Criterion {
  public:
    virtual ~Criterion() = default;

    // Returns what Observe() will read at `spp`, so that no view is built in vain.
    virtual ViewNeed Need(int spp) const = 0;

    // Takes note of the block after a pass and decides. To be called once after every pass, with
    // increasing spp, whatever Need() says, and no more once it has answered stop. Throws
    // std::invalid_argument if the spans that Need() asks for do not have the block's size, or if
    // spp or the size contradict earlier calls.
    virtual Decision Observe(const BlockView& view) = 0;

    // Return and set all that earlier calls of Observe() have left behind, for checkpoints.
    // Restore() throws std::runtime_error if `state` was saved by another rule or is damaged; the
    // criterion is then to be thrown away.
    virtual std::vector<std::byte> Save() const { return {}; }
    virtual void Restore(std::span<const std::byte> state);
};

// Says which block a criterion is for.
struct BlockInfo {
    int index = 0;            // row-major place in the grid of blocks
    double areaFraction = 1;  // pixels of the block / pixels of the image, in (0, 1]
};

// Measures what a rule looks at in a block.
using SignalMeasure = std::function<Signals(const BlockView& view, const BlockInfo& block)>;

// Holds what a rule can depend on beside its own text.
struct RuleContext {
    int passSpp = 20;            // spp of a pass, also of the first; 0: any (see FreeLooks)
    int blockCount = 0;          // blocks in the image; 0: not known
    int cap = 0;                 // spp that no block exceeds; 0: not known
    std::string sceneName = {};  // the row that `thresholds:FILE` takes; may be empty
    std::string models = {};     // the folder of installed models, NAME.h5; may be empty
    // Divides the threshold of visible noise: 2 lets half as much of it be. Above 0; others than 1
    // only for rules that have such a threshold.
    double caution = 1;
    NoiseVisibility visibility = {};  // to the rule `entropy`
    // By the name of a rule, what the program measures for it that a BlockView does not show. A
    // rule that needs that is refused where it is missing.
    std::map<std::string, SignalMeasure> measures = {};
};

struct VotingRule;

// Makes the criteria of an image. Models and tables are read once and shared by all of them.
struct CriterionFactory {
    std::string rule = {};      // as it was given, for headers and reports
    std::string checksum = {};  // of the file that the rule reads; empty if it reads none
    // How its stops lie to those of people, see network/human_range.h; empty: not known.
    std::vector<double> logRatios = {};
    RuleTrend trend = {};
    // Pixels a side below which a block does not judge itself but follows a neighbour (see
    // small_blocks.h); 0 for rules that only count samples.
    int smallestSide = 0;
    // Makes a criterion; can be called from any thread. Throws std::invalid_argument for a block
    // that the rule has no answer for.
    std::function<std::unique_ptr<Criterion>(const BlockInfo&)> make = {};
    // How it measures and decides; null for rules that only count samples.
    std::shared_ptr<const VotingRule> voting = nullptr;
    // Where those stop a block, in spp, before the end of the pass is waited for; throws as make().
    std::function<int(const BlockInfo&)> stopAt = {};
};

// The rule where none is asked for.
inline constexpr const char* defaultRule = "learned";

// The model of `learned` where none is named.
inline constexpr const char* defaultModelName = "entropy";

// Reads a stopping rule, NAME[:ARGUMENT] as kRules has them (rule_table.h), and the files it names.
// Throws std::invalid_argument for a bad rule and std::runtime_error for a bad file; the message
// says what is wrong and what would be right.
CriterionFactory MakeCriterionFactory(const std::string& rule, const RuleContext& context = {});

}  // namespace lull
