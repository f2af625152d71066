// Splits work over all cores so that the results do not depend on how many there are.
#pragma once

#include <atomic>
#include <functional>

namespace lull {

// Shows the thread sanitizer the order that oneTBB, which is not instrumented, gives to tasks: what
// one did before Leave() comes before what others do after Enter(). Whoever spawns tasks leaves
// before and enters after it has waited for them; a task enters at its start and leaves at its end.
class TaskOrder {
  public:
    void Enter() { edges.load(std::memory_order_acquire); }
    void Leave() { edges.fetch_add(1, std::memory_order_release); }

  private:
    std::atomic<unsigned> edges = 0;
};

// Runs body(0) ... body(count - 1), in any order and at the same time on as many threads as
// RunWithThreads() allows; may be called within a body. Passes on what a body throws.
void ForEachIndex(int count, const std::function<void(int)>& body);

// Runs `body` with at most `threads` threads for what it splits up; 0: one for each core.
void RunWithThreads(int threads, const std::function<void()>& body);

}  // namespace lull
