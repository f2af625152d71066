// All calls of MPI; without MPI they do nothing. For the main thread only.
#pragma once

#include <memory>

#include "renderer/render/peers.h"

namespace lull {

extern const bool hasMpi;  // whether the program was built with it

struct MpiWorld {
    int rank = 0, count = 1;
};

MpiWorld StartMpi();
// Waits for all ranks, rank 0 no longer than `patience` seconds, and ends MPI, if it was started.
// Returns false if one has not come.
bool EndMpi(double patience);
// Ends all ranks.
void AbortMpi(int exitCode);
std::unique_ptr<Peers> MakeMpiPeers();

}  // namespace lull
