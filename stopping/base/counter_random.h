// Makes random numbers that depend only on a seed and a purpose, so that an interrupted training
// continues with the same ones.
#pragma once

#include <cmath>
#include <cstdint>
#include <initializer_list>
#include <numbers>

namespace lull {

class CounterRandom {
  public:
    // Begins the sequence of a seed and a purpose, given as numbers.
    explicit CounterRandom(uint64_t seed, std::initializer_list<uint64_t> purpose = {})
        : key(Mix(seed)) {
        for (uint64_t p : purpose) key = Mix(key ^ Mix(p + 1));
    }

    uint64_t Next() { return Mix(key + ++count * kStep); }
    // Returns a number in [0, 1), a multiple of 2^-53.
    double Uniform() { return double(Next() >> 11) * 0x1p-53; }
    // Returns an integer in [0, limit), limit > 0.
    uint64_t Below(uint64_t limit) { return uint64_t(Uniform() * double(limit)); }
    // Returns a number from the standard normal distribution.
    double Normal() {
        const double radius = std::sqrt(-2 * std::log(1 - Uniform()));
        return radius * std::cos(2 * std::numbers::pi * Uniform());
    }

  private:
    static constexpr uint64_t kStep = 0x9e3779b97f4a7c15;

    // Mixes all bits into all others: the finalizer of splitmix64 (Steele, Lea, Flood 2014).
    static uint64_t Mix(uint64_t x) {
        x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9;
        x = (x ^ (x >> 27)) * 0x94d049bb133111eb;
        return x ^ (x >> 31);
    }

    uint64_t key, count = 0;
};

}  // namespace lull
