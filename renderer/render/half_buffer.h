// Decides whether a render keeps the sums of the half of the samples on which noise is estimated,
// 24 bytes a pixel.
#pragma once

#include "renderer/render/schedule.h"
#include "stopping/rules/rule.h"

namespace lull {

enum class HalfBuffer { Auto, On, Off };

// Says who looks at the half.
struct HalfUse {
    std::string rule;  // empty: the rule does not
    bool clock = false, page = false, denoiser = false;
    bool checkpoint = false;  // nobody does, but whoever goes on from it may
};

// Says whether a rule looks at the half after any of the passes of a block.
bool LooksAtHalf(const Rule&, const ScheduleOptions&);

// Says whether the half is to be kept. Throws Error where it is needed, but not wanted.
bool KeepsHalf(HalfBuffer, const HalfUse&);

}  // namespace lull
