// Monitors a block: where rules would have stopped it, how it looked there, and its noise.
#pragma once

#include <map>
#include <memory>
#include <vector>

#include "renderer/image/image_io.h"
#include "stopping/rules/rule.h"

namespace lull {

// Where a rule stopped a block, and at what cost, in CPU time.
struct RuleStop {
    int spp = 0;             // 0: it has not
    double seconds = 0;      // that the samples took until then; 0 if it has not stopped
    double ruleSeconds = 0;  // spent on the rule and its views so far
};

// The pixels of a block, row by row.
struct Snapshot {
    std::vector<float> mean;   // linear, R, G, B a pixel
    std::vector<float> noise;  // of the lightness (LightnessNoise::noise); empty unless asked for
};

// Numbers by spp, about ten to each doubling: the mean SVD-entropy of 100 sub-blocks, and the
// noise in lightness that is visible (VisibleNoise()).
struct BlockCurves {
    std::vector<int> spp;
    std::vector<float> entropy, noise;
};

struct BlockHistory {
    std::vector<RuleStop> stops;        // of each rule
    std::map<int, Snapshot> snapshots;  // by spp
    BlockCurves curves;
};

struct MonitorOptions {
    bool snapshots = false;  // where rules stop the block
    bool noise = false;      // in the snapshots
    bool curves = false;     // for blocks of at least 10 pixels a side
    bool goesOn = false;     // to the cap, rather than until all rules have stopped the block
};

// Runs several rules over one block, and decides as the first until that stops.
class BlockMonitor final : public Criterion {
  public:
    // A null rule does not check the block. `history` must outlive the monitor.
    BlockMonitor(std::vector<std::unique_ptr<Criterion>> rules, const MonitorOptions& options,
                 BlockHistory* history);

    ViewNeed Need(int spp) const override;
    Decision Observe(const BlockView& view) override;
    // Of the first rule.
    std::optional<double> NetworkNoise() const override { return networkNoise; }
    std::vector<std::byte> Save() const override;
    void Restore(std::span<const std::byte> state) override;

  private:
    Decision ObserveRule(size_t rule, const BlockView& view);
    void AddToCurves(const BlockView& view);

    std::vector<std::unique_ptr<Criterion>> rules;  // null once they have stopped the block
    MonitorOptions options;
    BlockHistory* history;
    std::optional<double> networkNoise;
};

// Judges blocks as graded pictures show them.

// The criterion of a block in a picture that is graded so.
struct GradedJudge {
    Grade grade;
    std::unique_ptr<Criterion> criterion;
};

// Shows a block to each judge until that has stopped it, and stops it once all have: the picture
// with the most visible noise counts. The numbers are of the judge farthest from it.
class GradedCriterion final : public Criterion {
  public:
    explicit GradedCriterion(std::vector<GradedJudge> judges);

    ViewNeed Need(int spp) const override;
    Decision Observe(const BlockView&) override;
    std::optional<double> NetworkNoise() const override { return networkNoise; }
    std::vector<std::byte> Save() const override;
    void Restore(std::span<const std::byte> state) override;

  private:
    std::vector<GradedJudge> judges;  // without a criterion once it has stopped the block
    std::optional<double> networkNoise;
};

}  // namespace lull
