// Estimates the missing samples of a render out of time, or with blocks at the cap.
#pragma once

#include "renderer/render/provenance.h"
#include "renderer/render/render.h"

namespace lull {

// A block that has not stopped.
struct NoisyBlock {
    int block;             // its index in the list of all
    double noise;          // visible, in lightness of 0 to 100
    int neededSpp;         // at which it would probably stop; at most the cap
    double neededSeconds;  // of processors, until then
};

// Returns the blocks that have not stopped, the noisiest first. Rules that count samples say where
// a block will stop; otherwise noise is taken to fall as 1 / sqrt(spp), to the threshold of
// `lnoise`, or to the median noise of the blocks that the rule has stopped, or to the default of
// `lnoise` if there are none. For results of a render with a clock.
std::vector<NoisyBlock> FindShortfall(const Provenance&, const RenderResult&);

// A block that its rule has not stopped before the cap.
struct CappedBlock {
    int block;                // its index in the list of all
    double value, threshold;  // last value of the rule, and its threshold
    int neededSpp;            // at which it would probably stop; 0: not to be told
};

// Returns the blocks at the cap, the furthest from stopping first: none for a rule that counts
// samples. The value of the rule is extrapolated (forecast.h).
std::vector<CappedBlock> FindCapped(const RenderResult&);

// Returns a cap in round numbers at which all of them have probably stopped; 0: not to be told.
int CapFor(const std::vector<CappedBlock>&, int cap);

// Returns the wall-clock seconds that all of them need, at the speed of the render.
double NeededSeconds(const std::vector<NoisyBlock>&, const RenderResult&);

}  // namespace lull
