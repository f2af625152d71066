// Decides when a learned rule votes and when its votes are enough.
#pragma once

#include <numeric>

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

// Counts noiseless votes in a row; the paper asks for three, as single ones can be wrong.
struct VoteCounter {
    int needed = 3;
    int inRow = 0;

    // Counts a vote: noiseless if the probability of noise is below 1/2, and noisy otherwise (so
    // for NaN). A noisy vote starts the count again.
    void Cast(double noisyProbability) { inRow = noisyProbability < 0.5 ? inRow + 1 : 0; }
    bool Stops() const { return inRow >= needed; }
};

}  // namespace lull
