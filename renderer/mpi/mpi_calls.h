// All calls of MPI; without MPI they do nothing. For the main thread only.
#pragma once

#include <algorithm>
#include <chrono>
#include <memory>
#include <thread>

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
void AbortMpi(int exitCode);
std::unique_ptr<Peers> MakeMpiPeers();

// Waits between looks, without taking a core from ranks that still load the scene, or write files.

// Waits twice as long each time, up to a limit.
class Backoff {
  public:
    void Wait() {
        constexpr std::chrono::microseconds kLongest{10000};
        std::this_thread::sleep_for(length);
        length = std::min(2 * length, kLongest);
    }
    double Seconds() const { return std::chrono::duration<double>(Clock::now() - start).count(); }

  private:
    using Clock = std::chrono::steady_clock;

    Clock::time_point start = Clock::now();
    std::chrono::microseconds length{50};
};

}  // namespace lull
