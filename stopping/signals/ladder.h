// Keeps those few of a block's growing number of states that later ones are compared with.
#pragma once

#include <cmath>
#include <cstddef>
#include <vector>

namespace lull {

// A ladder is a vector of entries with a member spp, increasing; the last one is the latest. The
// others are at least a step apart, so that there are eight an octave: near enough to any spp that
// is asked for, and few however many samples there are. Which entries are kept depends only on the
// spp at which they were added.
inline bool IsLadderStep(int from, int to) { return 11 * double(to) >= 12 * double(from); }

// Adds an entry with more spp than all others. Forgets what is no longer needed to find any spp
// from its own / depth on.
template <typename Entry>
void AddToLadder(Entry entry, double depth, std::vector<Entry>* ladder) {
    std::vector<Entry>& l = *ladder;
    if (l.size() > 1 && !IsLadderStep(l[l.size() - 2].spp, l.back().spp)) l.pop_back();
    size_t old = 0;
    while (old + 1 < l.size() && l[old + 1].spp <= entry.spp / depth) ++old;
    l.erase(l.begin(), l.begin() + std::ptrdiff_t(old));
    l.push_back(std::move(entry));
}

// Returns the entry that is nearest to `spp` by its ratio, within a factor of `tolerance`; null if
// there is none. Ignores the latest entry if `earlier`.
template <typename Entry>
const Entry* FindInLadder(const std::vector<Entry>& ladder, double spp, double tolerance,
                          bool earlier) {
    const Entry* best = nullptr;
    double least = std::log(tolerance);
    for (size_t i = 0; i + (earlier ? 1 : 0) < ladder.size(); ++i) {
        const double distance = std::abs(std::log(ladder[i].spp / spp));
        if (distance > least) continue;
        least = distance;
        best = &ladder[i];
    }
    return best;
}

}  // namespace lull
