// Decides when a rule looks at a block and votes, and when its votes are enough.
#pragma once

#include <cstdint>
#include <numeric>
#include <stdexcept>

#include "stopping/base/state.h"

namespace lull {

// Says at which spp features are recorded and votes cast: votes at firstSpp + j * voteSpacing,
// each on the features of the last k steps of n spp. All spp and counts are > 0.
struct VoteSchedule {
    int firstSpp = 20;     // the end of the first pass
    int n = 40;            // spp between the features of a window
    int voteSpacing = 20;  // spp between votes

    bool Votes(int spp) const { return spp >= firstSpp && (spp - firstSpp) % voteSpacing == 0; }
    // Returns whether some vote, now or later, looks at the features of this spp.
    bool Records(int spp) const { return spp >= firstSpp && (spp - firstSpp) % Spacing() == 0; }
    // Returns the spp between recorded features.
    int Spacing() const { return std::gcd(n, voteSpacing); }
};

// Says which states a rule looks at where they come at any spp: those that are at least `spacing`
// spp after the last one that it looked at.
struct FreeLooks {
    int spacing = 40;
    int last = 0;  // spp; 0: none yet

    bool Looks(int spp) const { return last == 0 || spp - last >= spacing; }

    // Reads what the rule has saved; throws std::runtime_error if it is damaged.
    void Restore(StateReader* reader) {
        last = reader->Get<int32_t>();
        if (last < 0) throw std::runtime_error("the saved looks of a stopping rule are damaged");
    }
};

// Counts noiseless votes in a row; the paper asks for three, as single ones can be wrong.
struct VoteCounter {
    int needed = 3;
    int inRow = 0;

    // Counts a vote: noiseless if the number is below the threshold, and noisy otherwise (so for
    // NaN). A noisy vote starts the count again.
    void Cast(double number, double threshold) { inRow = number < threshold ? inRow + 1 : 0; }
    bool Stops() const { return inRow >= needed; }
};

}  // namespace lull
