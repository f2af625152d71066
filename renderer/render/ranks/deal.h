// Decides which tiles each of several ranks renders, by how fast they are. Pure, without pixels.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace lull {

// Returns the ranks in turn, each once.
std::vector<int> EvenDeal(int ranks);

// Returns a sequence in which each rank is as often as its speed asks for, but at least once, and
// evenly spread. Speeds are > 0, in any unit.
std::vector<int> DealBySpeed(const std::vector<double>& speeds);

// Records the work of ranks since the tiles were distributed.
class RankSpeeds {
  public:
    explicit RankSpeeds(int ranks) : efforts(size_t(ranks)) {}

    // `seconds` are those that the rank's threads took for their tiles, as clocks have it, divided
    // by the number of its threads.
    void Add(int rank, int64_t samples, double seconds);
    void Forget();

    // Returns samples a second of each rank; empty while one has done nothing, or the busiest has
    // not taken `leastSeconds`.
    std::vector<double> Speeds(double leastSeconds) const;

  private:
    struct Effort {
        int64_t samples = 0;
        double seconds = 0;
    };
    std::vector<Effort> efforts;
};

// Returns how many times as fast all ranks together would be if the tiles were dealt out by their
// speeds rather than by `deal`, which goes at the pace of the rank that has most to do for its
// speed. At least 1.
double GainOfDealing(const std::vector<double>& speeds, const std::vector<int>& deal);

}  // namespace lull
