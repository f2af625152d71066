// Measures work by the time that threads have spent on a processor.
#pragma once

#include <ctime>

namespace lull {

// Returns the seconds that the calling thread has run; only differences mean anything. On a shared
// machine, wall-clock time would measure how busy the others are.
inline double ThreadSeconds() {
    timespec now;
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
    return double(now.tv_sec) + 1e-9 * double(now.tv_nsec);
}

}  // namespace lull
