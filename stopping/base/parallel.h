// Splits work over all cores so that the results do not depend on how many there are.
#pragma once

#include <atomic>
#include <functional>

namespace lull {

// Shows the thread sanitizer the order in which oneTBB, which is not instrumented, runs tasks:
// everything before Leave() happens before everything after Enter(). Whoever spawns tasks leaves
// before that, and enters after waiting for them; a task enters at its start and leaves at its end.
class TaskOrder {
  public:
    void Enter() { edges.load(std::memory_order_acquire); }
    void Leave() { edges.fetch_add(1, std::memory_order_release); }

  private:
    std::atomic<unsigned> edges = 0;
};

// Runs body(0) ... body(count - 1), in any order and concurrently on as many threads as
// RunWithThreads() allows; may be nested. Rethrows exceptions of the body.
void ForEachIndex(int count, const std::function<void(int)>& body);

// Returns how many threads `threads` stands for: 0 for one per core, and no more than oneTBB gives.
int ThreadCount(int threads);

// Runs `body` with at most `threads` threads for its parallel parts; 0: one per core.
void RunWithThreads(int threads, const std::function<void()>& body);

}  // namespace lull
