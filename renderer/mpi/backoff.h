// Waits between looks, without taking a core from ranks that still load the scene, or write files.
#pragma once

#include <algorithm>
#include <chrono>
#include <thread>

namespace lull {

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
