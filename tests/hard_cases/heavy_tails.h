// Samples of which the few that matter are rare: rules that look at the samples that they stop can
// stop just where those are still missing, and leave the image too dark.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace lull {

// Describes how the contributions of paths are distributed. All pixels have the same mean, 0.25.
struct Tail {
    std::string name;
    double rarity;  // the share of the paths that find the rare light; 0: there is none
    double share;   // of the mean that the rare light carries
    double spread;  // standard deviation of the rest over its mean
};

std::vector<Tail> HeavyTails();

// Stop of a rule on a block.
struct StopOutcome {
    int spp = 0;        // 10,000 where it never stops
    double bias = 0;    // of the block's mean, relative
    double error = 0;   // RMS over the pixels, relative
    double unseen = 0;  // share of the pixels that have not seen the rare light by then
};

// Runs each rule on the same samples of a block of 100 x 100 pixels.
std::vector<StopOutcome> StopBlocks(const Tail& tail, const std::vector<std::string>& rules,
                                    uint64_t seed);

// The rules with their usual settings.
std::vector<std::string> UsualRules();

}  // namespace lull
