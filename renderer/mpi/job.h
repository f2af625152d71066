// Knows whether this process is one of several that share a render, as mpirun or srun start them.
#pragma once

#include <memory>
#include <string>

#include "renderer/render/peers.h"

namespace lull {

// Thrown if another rank has failed, which reports its error itself.
struct OtherRankFailed {};

// Starts MPI if this is one of several processes, and only then. The output of all ranks but the
// first is discarded. There can be only one; used by the main thread.
class Job {
  public:
    // Throws Error if there are several processes but this program was built without MPI.
    Job();
    ~Job();

    int Rank() const { return rank; }
    int Count() const { return count; }
    // Returns what talks to the others; null if there are none.
    Peers* ThePeers() { return peers.get(); }

    // Waits until all ranks are ready to begin, and checks that all are about to render the same
    // thing, which `what` describes completely. Throws Error, or OtherRankFailed.
    void Begin(const std::string& what);
    // Declares that the others are not needed until the next Begin().
    void End() { phase = Phase::After; }
    // Declares that a rank gives no sign of life, and will not be waited for again.
    void GiveUp(int rank) { givenUp = rank; }
    // Ends this process, and all others, with the exit code, if one of them was given up: it would
    // not end by itself. Else does nothing.
    void EndWithout(int exitCode);
    // Prints a warning, whatever the rank.
    void Warn(const std::string& message) const;
    // Prints an error, once for all ranks, and ends them all if others would wait for this one.
    void Fail(const std::string& message);

  private:
    enum class Phase { Before, Working, After };

    int rank = 0, count = 1;
    int givenUp = -1;  // the last rank that was; -1: none
    Phase phase = Phase::Before;
    int errorOutput = 2;  // where errors go; 2 itself is silenced in all ranks but the first
    std::unique_ptr<Peers> peers;
};

}  // namespace lull
