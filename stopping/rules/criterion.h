// Defines the one interface between renderer and stopping rules: after each pass a block is shown
// to its criterion, which answers continue or stop.
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "stopping/base/block_view.h"

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
    // The noise that a network was told, where that is all it looks at: see RuleTrend::undecided.
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
};

// Says how the number that a rule compares goes with the samples.
struct RuleTrend {
    enum Kind {
        Error,        // above 0; falls as a power of the spp
        Probability,  // in [0, 1]; falls too
        Samples       // the spp themselves, which rise to the threshold
    };
    Kind kind = Error;
    int votes = 1;  // in a row that stop a block
    // Of a network that looks at nothing but noise, Decision::noise: where it is undecided.
    // Forecasts follow that then, as a probability is no power of the spp. 0: not known.
    double undecided = 0;
    // The spp of the picture that noise is compared with: it falls as a power of 1/spp -
    // 1/reference. 0: it is compared with none.
    int reference = 0;
    // Whether it falls more slowly where there is much noise, as falls of entropies do, and comes
    // to the power -1/2 with less.
    bool saturates = false;
};

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
    std::function<std::unique_ptr<Criterion>(const BlockInfo&)> make;
};

// The rule where none is asked for.
inline constexpr const char* defaultRule = "learned";

// The model of `learned` where none is named.
inline constexpr const char* defaultModelName = "entropy";

// Returns the file of the model that `learned:ARGUMENT` names: one that ends in .h5 or is there, or
// NAME.h5 in the folder of installed models. Throws std::runtime_error naming those that there are.
std::string ModelPath(const std::string& argument, const std::string& models);

// Reads a model as it is used in a context, with its cap and caution. Throws std::runtime_error.
struct Model;
Model ReadModelFor(const std::string& path, const RuleContext& context);

// Reads a stopping rule and the files it names:
//     fixed:N                 stop at N samples per pixel
//     dammertz[:T[:area]]     stop when the block's mean error is < T (0.02: in the middle greys
//                             about two steps of an 8-bit display)
//     cycles:T                stop when no pixel's error is >= T
//     luxtile:T               stop when the largest display error is < T, e.g. 0.0234 = 6/256
//     lnoise[:T]              stop when the visible noise in lightness is < T three times in a row
//                             (0.9: where people stop to see it, see stopping/models/README.md)
//     entropy[:T]             stop when noise adds so little to the SVD-entropy that < T of it is
//                             visible, three times in a row (see entropy.h)
//     thresholds:FILE[:NAME]  stop each block at the spp of a row in a thresholds file
//     learned[:NAME|MODEL.h5] stop after noiseless votes of a recurrent network in a row, an
//                             installed one (entropy) or one in a file
// Throws std::invalid_argument for a bad rule and std::runtime_error for a bad file; the message
// says what is wrong and what would be right.
CriterionFactory MakeCriterionFactory(const std::string& rule, const RuleContext& context = {});

}  // namespace lull
