// The rounds of a learner.
#pragma once

#include "renderer/schedule/schedule.h"

namespace lull {

struct Rounds {
    int round = 0;          // 0: nothing is recorded yet
    int end = kNoRoundEnd;  // of the round, in spp; kNoRoundEnd: learning is done

    bool IsDone() const { return end == kNoRoundEnd; }
    // Returns whether samples are recorded.
    bool Record() const { return round > 0 && !IsDone(); }
};

// The end of a round, which a learner has asked for, or which is that of light paths.
struct RoundEnd {
    int spp;
    bool goesOn;  // another round follows; false: the render ends here, or is interrupted
};

}  // namespace lull
