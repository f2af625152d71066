// Has all ranks begin a render, if it is the same for all.
#pragma once

#include <cstdint>

#include "renderer/render/peers.h"

namespace lull {

// Combined reports of all ranks.
struct Agreement {
    int failed = -1;      // the first rank that has failed; -1: none
    int different = -1;   // the first whose value is not that of rank 0; -1: none
    bool isLate = false;  // the others have not waited for this one: they may be at work
};

// Waits until all ranks have come to their agreement number `round` > 0, rank 0 no longer than
// `patience` seconds. Those that come later are told of no ranks but 0 and themselves.
Agreement Agree(Peers*, int round, bool failed, uint64_t value, double patience);

}  // namespace lull
