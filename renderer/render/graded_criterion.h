// Judges blocks as graded pictures show them.
#pragma once

#include <memory>
#include <vector>

#include "renderer/image/grade.h"
#include "stopping/rules/criterion.h"

namespace lull {

// The criterion of a block in a picture that is graded so.
struct GradedJudge {
    Grade grade;
    std::unique_ptr<Criterion> criterion;
};

// Shows a block to each judge until that has stopped it, and stops it once all have: the picture
// with the most visible noise counts. The numbers are those of the judge that is farthest from
// stopping.
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
