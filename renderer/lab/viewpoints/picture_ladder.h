// Keeps how a block looks on a display at a ladder of samples per pixel, for people to judge.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "stopping/rules/criterion.h"

namespace lull {

// The pixels of a block as a display shows them: 8-bit sRGB, R, G, B, row by row.
using DisplayPixels = std::vector<uint8_t>;

// Returns the spp of a ladder whose steps are as near to `ratio` (> 1) as whole passes allow:
// increasing multiples of `pass` from `pass` on, and `cap` as the last.
std::vector<int> LadderByRatio(int pass, int cap, double ratio);

// Returns such a ladder with `count` (>= 2) levels, or fewer if there are not that many passes.
std::vector<int> LadderByCount(int pass, int cap, int count);

// Continues to the last level and keeps a picture at each; `pictures`, which must outlive it,
// receives them in the order of the levels. Shows all passes to `companion` too, if there is one: a
// recorder of the same samples.
class PictureLadder final : public Criterion {
  public:
    PictureLadder(std::vector<int> levels, std::unique_ptr<Criterion> companion,
                  std::vector<DisplayPixels>* pictures);

    ViewNeed Need(int spp) const override;
    Decision Observe(const BlockView& view) override;
    std::vector<std::byte> Save() const override;
    void Restore(std::span<const std::byte> state) override;

  private:
    bool IsLevel(int spp) const;

    std::vector<int> levels;
    std::unique_ptr<Criterion> companion;
    std::vector<DisplayPixels>* pictures;
};

}  // namespace lull
