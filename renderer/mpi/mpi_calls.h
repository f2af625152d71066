// All calls of MPI; without MPI they do nothing. For the main thread only.
#pragma once

#include <cstdint>
#include <memory>

#include "renderer/render/peers.h"

namespace lull {

extern const bool hasMpi;  // whether the program was built with it

struct MpiWorld {
    int rank = 0, count = 1;
};

// Holds what all ranks have reported together.
struct MpiAgreement {
    int failed = -1;     // the first rank that has failed; -1: none
    int different = -1;  // the first whose value is not that of rank 0; -1: none
};

MpiWorld StartMpi();
void EndMpi();  // if it was started
// Waits for all ranks.
MpiAgreement AgreeByMpi(bool failed, uint64_t value);
// Ends all ranks.
void AbortMpi(int exitCode);
std::unique_ptr<Peers> MakeMpiPeers();

}  // namespace lull
