// Who looks at the sums of half of the samples, on which noise is estimated, 24 bytes a pixel.
#pragma once

#include "renderer/schedule/schedule.h"
#include "stopping/rules/rule.h"

namespace lull {

// Returns whether a rule looks at the half after any of the passes of a block.
bool LooksAtHalf(const Rule&, const ScheduleOptions&);

}  // namespace lull
