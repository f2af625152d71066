// Knows whether this process is one of several that share a render, as mpirun or srun start them.
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>

#include "renderer/render/peers.h"

namespace lull {

// Has all ranks begin a render, if it is the same for all.

// Combined reports of all ranks.
struct Agreement {
    int failed = -1;      // the first rank that has failed; -1: none
    int different = -1;   // the first whose value is not that of rank 0; -1: none
    bool isLate = false;  // the others have not waited for this one: they may be at work
};

// Waits until all ranks have come to their agreement number `round` > 0, rank 0 no longer than
// `patience` seconds. Those that come later are told of no ranks but 0 and themselves.
Agreement Agree(Peers*, int round, bool failed, uint64_t value, double patience);

// Thrown if another rank has failed, which reports its error itself.
struct OtherRankFailed {};

// Starts MPI if this is one of several processes, and only then. The output of all ranks but the
// first is discarded. There can be only one; used by the main thread.
class MpiJob {
  public:
    // Throws Error if there are several processes but this program was built without MPI.
    MpiJob();
    ~MpiJob();

    int Rank() const { return rank; }
    int Count() const { return count; }
    // Returns the connection to the other ranks; null if there are none.
    Peers* GetPeers() { return peers.get(); }

    // Waits until all ranks are ready to begin, and checks that all are about to render the same
    // thing, which `what` describes completely. A rank that has been silent for longer than rank 0
    // was busy before, and a minute, is not waited for. Throws Error, or OtherRankFailed.
    void Begin(const std::string& what);
    // Replaces that minute by a tenth of the time left by the clock, but at least five seconds.
    void SetClock(std::function<double()> secondsLeft) { clock = std::move(secondsLeft); }
    // Declares that the others are not needed until the next Begin().
    void End();
    // Declares that a rank gives no sign of life, and will not be waited for again.
    void GiveUp(int rank) { givenUp = rank; }
    // Waits for the others to come here. Ends this process, and all others, with the exit code, if
    // one of them was given up, or does not come: it would not end by itself.
    void Leave(int exitCode);
    // Has warnings and errors put into the lines that wording(kind, message) returns.
    using Wording = std::function<std::string(const std::string& kind, const std::string& message)>;
    void SetWording(Wording given) { wording = std::move(given); }
    void Warn(const std::string& message) const;
    // Prints errors, one for each line, once for all ranks, and ends them all if others would wait
    // for this one.
    void Fail(const std::string& message);

  private:
    enum class Phase { Before, Working, After };

    double Patience() const;
    Agreement AgreeWithOthers(bool failed, uint64_t value);

    int rank = 0, count = 1;
    int givenUp = -1;  // the last rank that was; -1: none
    Phase phase = Phase::Before;
    int rounds = 0;  // of agreement
    std::chrono::steady_clock::time_point start = std::chrono::steady_clock::now();
    std::function<double()> clock;
    int errorOutput = 2;  // where errors go; 2 itself is silenced in all ranks but the first
    Wording wording = [](const std::string& kind, const std::string& message) {
        return "lull: " + kind + ": " + message + "\n";
    };
    std::unique_ptr<Peers> peers;
};

}  // namespace lull
