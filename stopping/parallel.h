// Splits work over all cores so that the results do not depend on how many there are.
#pragma once

#include <functional>

namespace lull {

// Runs body(0) ... body(count - 1), in any order and at the same time on as many threads as
// RunWithThreads() allows; may be called within a body. Passes on what a body throws.
void ForEachIndex(int count, const std::function<void(int)>& body);

// Runs `body` with at most `threads` threads for what it splits up; 0: one for each core.
void RunWithThreads(int threads, const std::function<void()>& body);

}  // namespace lull
