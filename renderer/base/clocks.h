// Measures wall-clock time, and work by the time that threads have spent on a processor.
#pragma once

#include <chrono>
#include <ctime>

namespace lull {

inline double SecondsSince(std::chrono::steady_clock::time_point start) {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

// Returns the seconds of a clock of processors.
inline double SecondsOf(clockid_t clock) {
    timespec now;
    clock_gettime(clock, &now);
    return double(now.tv_sec) + 1e-9 * double(now.tv_nsec);
}

// Returns the seconds that all threads of the program have run; only differences mean anything.
inline double ProcessSeconds() { return SecondsOf(CLOCK_PROCESS_CPUTIME_ID); }

// Returns the seconds that the calling thread has run; only differences mean anything. On a shared
// machine, wall-clock time would measure how busy the others are.
inline double ThreadSeconds() { return SecondsOf(CLOCK_THREAD_CPUTIME_ID); }

}  // namespace lull
