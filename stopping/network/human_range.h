// Estimates between which spp people would have ceased to see noise in a block that a rule has
// stopped.
#pragma once

#include <optional>
#include <span>
#include <vector>

namespace lull {

// The spp at which the human thresholds end: observers were shown no more.
inline constexpr int kMostShownSpp = 10000;

// How a rule's stops S relate to the thresholds T of people on blocks that it had not seen: the
// quantiles of log(T / S) at 0, 10, ..., 100 %.
inline constexpr int kLogRatios = 11;

// The middle 80 % of the thresholds that people would have had.
struct HumanRange {
    int low = 0;                   // spp
    std::optional<int> high = {};  // nothing: more than people were shown, or not known
};

// Returns the range of a block that took `stop` > 0 spp: stopped by its rule or, if not, by the
// cap, in which case only the lower end is known. `logRatios` holds kLogRatios finite numbers that
// do not decrease.
HumanRange RangeOfPeople(int stop, bool stoppedByRule, std::span<const double> logRatios);

}  // namespace lull
