// Waits between looks, without taking a core from ranks that still load the scene, or write files.
#pragma once

#include <algorithm>
#include <chrono>
#include <thread>

namespace lull {

class Nap {
  public:
    void Take() {
        constexpr std::chrono::microseconds longest{10000};
        std::this_thread::sleep_for(length);
        length = std::min(2 * length, longest);
    }
    double SecondsSinceFirst() const {
        return std::chrono::duration<double>(Clock::now() - first).count();
    }

  private:
    using Clock = std::chrono::steady_clock;

    Clock::time_point first = Clock::now();
    std::chrono::microseconds length{50};
};

}  // namespace lull
